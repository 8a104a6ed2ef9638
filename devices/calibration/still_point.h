#pragma once

#include <glm/vec3.hpp>

#include <span>

#include "devices/calibration/outcome.h"

namespace insonate {

/// Position of a point that was held still.
struct StillPoint {
  glm::dvec3 mean_mm{0};
  double wander_mm = 0;  ///< RMS distance of the single readings from the mean: noise of the tracker and of the hand
};

/// A hand that rests on something stays within 1 mm; magnetic trackers add up to 0.3 mm. At twice that the point
/// has moved.
inline constexpr double kMaxWander_mm = 2.5;
inline constexpr std::size_t kMinStillReadings = 10;

/// Returns the mean of readings (mm, any frame) of a point at rest. Refused with fewer than kMinStillReadings, or if
/// they wander by more than kMaxWander_mm.
Outcome<StillPoint> still_point(std::span<const glm::dvec3> readings_mm);

}  // namespace insonate
