// Recordings of what a tracker's device sent.
#include <limits>

#include "devices/replay/raw_replay.h"
#include "tests/devices/test_samples.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

const Target raw_target("raw", [](std::string_view bytes) -> std::string {
  const RawScan scan = parse_raw(bytes, "fuzzed.raw");
  if (scan.samples.empty()) return "a recording without samples was taken";
  double before_s = -std::numeric_limits<double>::infinity();
  for (const ProbeSample& sample : scan.samples) {
    if (!(sample.time_s > before_s)) return "the times do not rise";
    before_s = sample.time_s;
    if (sample.status == PoseStatus::ok && why_not_rigid(sample.patient_from_probe.matrix()))
      return "a pose is not rigid";
  }
  const std::string cut = std::string(bytes.substr(0, bytes.rfind('\n') + 1)) + "read 1";
  return same_bits(parse_raw(cut, "fuzzed.raw").samples, scan.samples) ? "" : "a last line that is cut counts";
});

}  // namespace
}  // namespace insonate::fuzz
