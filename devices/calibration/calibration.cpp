#include "devices/calibration/calibration.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <limits>

namespace insonate {

std::string TrackerIdentity::words() const {
  return kind + (serial.empty() ? "" : ", serial " + serial) +
         (sensor == 1 ? "" : ", sensor " + std::to_string(sensor));
}

Pose Calibration::patient_from_probe(const Pose& raw) const {
  return mannequin->value.ct_from_mannequin * mannequin->value.mannequin_from_tracker * tracker_from_sensor(raw) *
         face->value.fit.sensor_from_face;
}

std::string why_incomplete(const Calibration& calibration) {
  return !calibration.face ? "face" : !calibration.mannequin ? "landmarks" : "";
}

std::int64_t made_s(const Calibration& calibration) {
  std::int64_t oldest_s = std::numeric_limits<std::int64_t>::max();
  if (calibration.face) oldest_s = std::min(oldest_s, calibration.face->made_s);
  if (calibration.mannequin) oldest_s = std::min(oldest_s, calibration.mannequin->made_s);
  return oldest_s;
}

std::vector<std::string> calibration_warnings(const Calibration& calibration, const TrackerIdentity& tracker,
                                              std::int64_t now_s, double days) {
  std::vector<std::string> warnings;
  // A recording does not identify the tracker it came from.
  if (calibration.tracker != tracker && tracker.kind != "replay" && tracker.kind != "raw")
    warnings.push_back("The calibration was made with another tracker (" + calibration.tracker.words() + "); this is " +
                       tracker.words() + ".");
  const double age_days = (double(now_s) - double(made_s(calibration))) / 86400;
  if (age_days > days) {
    char text[120];
    std::snprintf(text, sizeof text, "The calibration is %.0f days old; check it, or calibrate again.",
                  std::floor(age_days));
    warnings.emplace_back(text);
  }
  return warnings;
}

}  // namespace insonate
