#include "app/registration/screen/registration_headless.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <thread>

#include "app/registration/live_session.h"
#include "app/registration/screen/registration_state.h"
#include "devices/live/steady_clock.h"
#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/files/new_folder.h"
#include "sim/tissue/tissue.h"
#include "tools/cli/subject.h"
#include "tools/register/result_files.h"

namespace insonate {
namespace {

constexpr double kUsual_s = 300;
constexpr auto kStep = std::chrono::milliseconds(10);
constexpr int kNotConverged = 3;

}  // namespace

int run_registration_headless(const RegistrationOptions& options) {
  const LiveRequest request = options.request();
  refuse_unwritable(options.out);
  const TissueTable table = read_tissue_table(assets_folder() / "tissues.toml");
  const Case subject = open_subject(request.subject);
  const AcousticVolume volume = make_acoustic_volume(subject.ct, subject.labels, tissue_by_label(subject), table);
  LiveSession session(request, subject, volume);
  const double end_s = steady_now_s() + (options.seconds > 0 ? options.seconds : kUsual_s);
  double written_s = -1;
  std::string waits_for;
  for (double now_s = steady_now_s(); now_s < end_s; now_s = steady_now_s()) {
    session.update(now_s);
    if (!options.state_file.empty() && now_s - written_s > kStateEvery_s) {
      written_s = now_s;
      write_registration_state(options.state_file, session);
    }
    // A server that is not there, or has gone, may come back: this goes on, but says what it waits for.
    if (const std::string problem = session.stream().problem(); problem != waits_for) {
      waits_for = problem;
      if (!problem.empty()) std::fprintf(stderr, "insonate: waiting: %s\n", problem.c_str());
    }
    const LiveRegistrar::State state = session.state();
    if (state.last && state.last->found.converged()) break;
    if (state.work == LiveRegistrar::Work::failed) break;
    std::this_thread::sleep_for(kStep);
  }
  if (!options.state_file.empty()) write_registration_state(options.state_file, session);  // how it ended
  const LiveRegistrar::State state = session.state();
  if (!state.last) {
    const std::string problem = session.problem();
    if (!problem.empty()) throw InputError(problem);
    if (state.work == LiveRegistrar::Work::preparing || state.work == LiveRegistrar::Work::searching)
      throw InputError(options.tracker, "", "the first search had not ended", "give it more --seconds");
    if (session.stream().received() == 0)
      throw InputError(options.tracker, "", "no image has come from it", "start the server, or give it more --seconds");
    throw InputError(options.tracker, "",
                     "its images do not suffice: " + std::to_string(state.in_use) + " within " +
                         formatted("%.0f", state.spread_mm) + " mm; needed are " + to_string(state.needs),
                     "move the probe, or give it more --seconds");
  }
  const std::filesystem::path saved = session.save(options.out, *state.last);
  if (session.fan()) std::printf("Found in the images: %s.\n", description(*session.fan()).c_str());
  std::printf("%s\nSaved to %s.\n", verdict(state.last->found).c_str(), saved.string().c_str());
  return state.last->found.converged() ? 0 : kNotConverged;
}

}  // namespace insonate
