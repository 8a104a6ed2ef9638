#pragma once

#include <optional>
#include <string_view>

#include "sim/core/pose.h"

namespace insonate {

/// Brings a sensor's pose in its tracker's frame to the probe's in the patient, before anybody has calibrated: where
/// the sensor first is, the probe is at its start, and the sensor's axes then are the probe's.
class Placement {
public:
  /// `raw`: hand over the sensor's pose in the tracker's frame as it is, for who calibrates.
  Placement(const Pose& start, bool raw) : start_(start), raw_(raw) {}

  Pose patient_from_probe(const Pose& tracker_from_sensor) {
    if (raw_) return tracker_from_sensor;
    if (!patient_from_tracker_) patient_from_tracker_ = start_ * tracker_from_sensor.inverse();
    return *patient_from_tracker_ * tracker_from_sensor;
  }

  /// What people have to know of how the probe got where it is; empty for the sensor's own pose.
  std::string_view remark() const {
    return raw_ ? "" : ", not calibrated: the probe began where the sensor was first seen";
  }

  /// The tracker's own origin in the frame that the poses come in.
  glm::dvec3 origin() const { return patient_from_tracker_ ? patient_from_tracker_->translation : glm::dvec3(0); }

private:
  Pose start_;
  bool raw_;
  std::optional<Pose> patient_from_tracker_;
};

}  // namespace insonate
