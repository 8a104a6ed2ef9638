#pragma once

#include <cstdint>
#include <optional>

#include "sim/core/probe_sample.h"

namespace insonate {

/// One reading of a tracker's sensor in the tracker's own frame: what a calibration is made of, and what a calibrated
/// tracker turns into a ProbeSample. The fields but the pose are those of a ProbeSample.
struct SensorSample {
  double time_s = 0;
  PoseStatus status = PoseStatus::unknown;
  Pose tracker_from_sensor;  ///< as the tracker reports it; meaningful only when status is ok
  std::uint32_t buttons = 0;
  std::optional<std::uint32_t> distortion{};
  Rejection rejected = Rejection::none;
};

}  // namespace insonate
