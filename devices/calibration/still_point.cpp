#include "devices/calibration/still_point.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <cstdio>

namespace insonate {

Outcome<StillPoint> still_point(std::span<const glm::dvec3> readings_mm) {
  if (readings_mm.size() < kMinStillReadings)
    return Refusal{"The tracker was not seen long enough there; hold still where it is seen and mark again."};
  StillPoint point;
  for (const glm::dvec3& reading : readings_mm) point.mean_mm += reading / double(readings_mm.size());
  double squares = 0;
  for (const glm::dvec3& reading : readings_mm) {
    const glm::dvec3 off = reading - point.mean_mm;
    squares += glm::dot(off, off);
  }
  point.wander_mm = std::sqrt(squares / double(readings_mm.size()));
  if (point.wander_mm <= kMaxWander_mm) return point;
  char text[120];
  std::snprintf(text, sizeof text, "The point moved by %.1f mm while it was read; hold it still and mark again.",
                point.wander_mm);
  return Refusal{text};
}

}  // namespace insonate
