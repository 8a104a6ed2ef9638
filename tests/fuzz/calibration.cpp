// The set-up file of a tracker.
#include "devices/calibration/calibration.h"

#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

const Target calibration_target("calibration", [](std::string_view bytes) -> std::string {
  const Calibration calibration = parse_calibration(bytes, "calibration.toml");
  const std::string text = to_toml(calibration);
  if (to_toml(parse_calibration(text, "written again")) != text) return "written and read again it is another";
  calibration_warnings(calibration, calibration.tracker, 1'700'000'000);
  if (!why_incomplete(calibration).empty()) return "";
  made_s(calibration);
  if (why_not_rigid(calibration.patient_from_probe(Pose{}).matrix(), 4 * kTrackerRange_mm))
    return "the probe's pose is not rigid";
  return "";
});

}  // namespace
}  // namespace insonate::fuzz
