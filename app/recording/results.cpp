#include "app/recording/results.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "devices/sequence/sequence.h"
#include "sim/core/input_error.h"
#include "sim/files/png.h"

namespace insonate {

namespace {

/// Returns the path of the patient that replaces the scenario's own; empty if none does.
std::string patient_of(const CaseSource& source) {
  const std::filesystem::path& patient = source.ct.empty() ? source.case_folder : source.ct;
  return patient.empty() ? "" : std::filesystem::absolute(patient).string();
}

}  // namespace

Sitting sitting_of(const Session& session, const CaseSource& source, const std::string& learner) {
  const Scenario& scenario = session.runner()->scenario();
  Sitting sitting;
  sitting.learner = learner;
  sitting.title = scenario.title;
  sitting.scenario_text = scenario.text;
  sitting.scenario_file = std::filesystem::absolute(scenario.file).string();
  sitting.patient = patient_of(source);
  sitting.seed = scenario.seed;
  return sitting;
}

Attempt finished_attempt(const Session& session, const CaseSource& source, const std::string& learner,
                         std::vector<ReportPicture> pictures) {
  if (!session.result() || !session.runner()) throw std::logic_error("the exam is not finished");
  Attempt attempt = attempt_of(*session.runner(), *session.result(),
                               write_sequence(session.exam_samples(), to_texts(session.actions())));
  attempt.learner = learner;
  attempt.finished_ms = now_since_1970_ms();
  attempt.patient = patient_of(source);
  attempt.pictures = std::move(pictures);
  return attempt;
}

ReportPicture report_picture(std::size_t step, ReportPicture::Kind kind, const Image<Rgba8>& ultrasound) {
  const auto is_grey = [](const Rgba8& pixel) { return pixel[0] == pixel[1] && pixel[0] == pixel[2]; };
  if (!std::ranges::all_of(ultrasound.pixels, is_grey)) return {step, kind, png_bytes(ultrasound)};
  Image<std::uint8_t> grey(ultrasound.width, ultrasound.height);
  std::transform(ultrasound.pixels.begin(), ultrasound.pixels.end(), grey.pixels.begin(),
                 [](const Rgba8& pixel) { return pixel[0]; });
  return {step, kind, png_bytes(grey)};
}

std::filesystem::path own_results() {
  for (const auto& [variable, folder] : {std::pair{"XDG_DATA_HOME", "insonate"}, {"HOME", ".local/share/insonate"}})
    if (const char* base = std::getenv(variable); base && *base)
      return std::filesystem::path(base) / folder / "results.db";
  throw InputError("environment", "", "neither XDG_DATA_HOME nor HOME says where to keep results",
                   "set HOME, or name a database with --results");
}

}  // namespace insonate
