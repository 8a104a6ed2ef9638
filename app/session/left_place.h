#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "sim/core/pose_sample.h"

namespace insonate {

/// Lets a tracker that tells no place (Tracker::relative) go on from where the probe was left: its poses are moved as a
/// whole, so that the next usable one lies there.
class LeftPlace {
public:
  void leave_at(const Pose& place) { place_ = place; }

  /// To be shown all that the tracker says, in order.
  void move(std::vector<PoseSample>& samples) {
    for (PoseSample& sample : samples) {
      if (sample.status != PoseStatus::ok) continue;
      if (place_) by_ = *place_ * sample.patient_from_probe.inverse();
      place_.reset();
      if (by_) sample.patient_from_probe = *by_ * sample.patient_from_probe;
    }
  }

private:
  std::optional<Pose> place_;  ///< until the next pose comes
  std::optional<Pose> by_;
};

}  // namespace insonate
