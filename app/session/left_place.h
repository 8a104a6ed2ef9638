#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "sim/core/probe_sample.h"

namespace insonate {

/// Lets a tracker without an absolute position (Tracker::relative) continue from where the probe was left. It moves all
/// poses by one rigid transform, chosen so that the next usable pose lies at that place.
class LeftPlace {
public:
  void leave_at(const Pose& place) { place_ = place; }

  /// Must see all samples of the tracker, in order.
  void move(std::vector<ProbeSample>& samples) {
    for (ProbeSample& sample : samples) {
      if (sample.status != PoseStatus::ok) continue;
      if (place_) by_ = *place_ * sample.patient_from_probe.inverse();
      place_.reset();
      if (by_) sample.patient_from_probe = *by_ * sample.patient_from_probe;
    }
  }

private:
  std::optional<Pose> place_;  ///< set until the next usable pose comes
  std::optional<Pose> by_;
};

}  // namespace insonate
