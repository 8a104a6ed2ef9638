#pragma once

#include <optional>
#include <string_view>

#include "sim/core/pose.h"

namespace insonate {

/// Converts a sensor's pose in its tracker's frame to the probe's in the patient, without a calibration. Where the
/// sensor is first seen, the probe is at its start pose, and the sensor's axes at that time are the probe's.
class Placement {
public:
  /// @param raw  true: return the sensor's pose in the tracker's frame unchanged, for a calibration
  Placement(const Pose& start, bool raw) : start_(start), raw_(raw) {}

  Pose patient_from_probe(const Pose& tracker_from_sensor) {
    if (raw_) return tracker_from_sensor;
    if (!patient_from_tracker_) patient_from_tracker_ = start_ * tracker_from_sensor.inverse();
    return *patient_from_tracker_ * tracker_from_sensor;
  }

  /// Returns what users must know about this placement; empty for raw poses.
  std::string_view remark() const {
    return raw_ ? "" : ", not calibrated: the probe began where the sensor was first seen";
  }

  /// Returns the tracker's own origin in the frame of the returned poses.
  glm::dvec3 origin() const { return patient_from_tracker_ ? patient_from_tracker_->translation : glm::dvec3(0); }

private:
  Pose start_;
  bool raw_;
  std::optional<Pose> patient_from_tracker_;
};

}  // namespace insonate
