// insonate-devices watch: shows a tracker's output.

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "devices/live/steady_clock.h"
#include "devices/record/raw_recorder.h"
#include "devices/record/sequence_recorder.h"
#include "devices/registry.h"
#include "sim/core/input_error.h"
#include "tools/devices/commands.h"

namespace insonate::devices {
namespace {

void print(const ProbeSample& sample) {
  std::printf("%.6f %-13s", sample.time_s, std::string(to_string(sample.status)).c_str());
  if (sample.status == PoseStatus::ok) {
    const glm::dvec3& p = sample.patient_from_probe.translation;
    const glm::dquat q = glm::quat_cast(sample.patient_from_probe.rotation);
    std::printf(" %9.3f %9.3f %9.3f mm  %8.5f %8.5f %8.5f %8.5f", p.x, p.y, p.z, q.w, q.x, q.y, q.z);
  }
  if (sample.distortion) std::printf("  distortion %u", unsigned(*sample.distortion));
  if (sample.rejected != Rejection::none)
    std::printf("  rejected: %s", std::string(to_string(sample.rejected)).c_str());
  if (sample.buttons) std::printf("  buttons %x", unsigned(sample.buttons));
  std::printf("\n");
}

/// Set by Ctrl C, which ends a recording as its time limit does: the file is completed.
volatile std::sig_atomic_t stopped = 0;

struct WatchRequest {
  std::string uri, record, record_raw;
  double seconds = 1e9;
};

int watch(const WatchRequest& request) {
  const double seconds = request.seconds;
  const auto tracker = open_tracker(request.uri);
  std::optional<SequenceRecorder> recorder;
  if (!request.record.empty()) recorder.emplace(request.record);
  std::shared_ptr<const RawRecorder> raw;
  if (!request.record_raw.empty()) raw = record_raw(*tracker, request.record_raw, request.uri);
  if (recorder || raw) std::signal(SIGINT, [](int) { stopped = 1; });
  // Only a live tracker needs real time; the others count exactly from zero.
  const double begin_s = steady_now_s(), start_s = tracker->live() ? begin_s : 0;
  std::string problem;
  std::vector<ProbeSample> samples;
  std::fprintf(stderr, "%s\n", tracker->state().name.c_str());
  std::printf("time_s status x y z (probe's face in the patient, LPS) qw qx qy qz\n");
  for (double now_s = 0;;) {
    samples.clear();
    tracker->poll(start_s + now_s, samples);
    for (const ProbeSample& sample : samples) {
      print(sample);
      if (recorder) recorder->add(sample);
    }
    if (recorder) recorder->flush();
    std::fflush(stdout);
    if (std::string now = tracker->state().problem; now != problem) {
      problem = std::move(now);
      if (!problem.empty()) std::fprintf(stderr, "%s\n", problem.c_str());
    }
    if (raw && !raw->problem().empty()) throw InputError(raw->problem());
    if (stopped || now_s >= seconds || tracker->state().condition == TrackerCondition::finished) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    now_s = std::min(seconds, steady_now_s() - begin_s);
  }
  const TrackerState state = tracker->state();
  std::fprintf(stderr, "%s: %s, %llu samples, %llu usable, %llu dropped, %.1f Hz\n", state.name.c_str(),
               std::string(to_string(state.condition)).c_str(), static_cast<unsigned long long>(state.delivered),
               static_cast<unsigned long long>(state.usable), static_cast<unsigned long long>(state.dropped),
               state.rate_hz);
  if (recorder) {
    const std::size_t frames = recorder->frames();
    recorder->finish();
    std::fprintf(stderr, "recorded %zu samples to %s\n", frames, request.record.c_str());
  }
  if (raw) std::fprintf(stderr, "recorded what its device sent to %s\n", request.record_raw.c_str());
  return 0;
}

}  // namespace

Command watch_command(CLI::App& program) {
  const auto request = std::make_shared<WatchRequest>();
  CLI::App* parser = program.add_subcommand("watch", "Print a tracker's samples as they arrive");
  parser->add_option("URI", request->uri, "Watch this tracker; 'list' shows the forms of a URI")
      ->required()
      ->type_name("URI");
  parser->add_option("--seconds", request->seconds, "Stop after this many seconds")->check(CLI::PositiveNumber);
  parser->add_option("--record", request->record, "Record the samples as a sequence file too (.igs.mha)")
      ->type_name("FILE");
  parser
      ->add_option("--record-raw", request->record_raw,
                   "Record what the device sends, byte for byte; 'raw:FILE' replays it")
      ->type_name("FILE");
  return {parser, [request] { return watch(*request); }};
}

}  // namespace insonate::devices
