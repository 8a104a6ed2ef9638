#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "devices/bytes.h"
#include "sim/core/pose_sample.h"

namespace insonate {

/// Why the bytes of a report were not taken.
enum class ReportFault {
  none,
  length,    ///< shorter or longer than such a report is
  header,    ///< does not begin as such a report does
  checksum,  ///< its own checksum disagrees
};

std::string_view to_string(ReportFault fault);

/// What a parser makes of a report's bytes; `report` is meaningful only without a fault.
template <typename Report>
struct Parsed {
  ReportFault fault = ReportFault::none;
  Report report;
};

/// One sensor of a tracker that tells place and direction, in the tracker's own frame and as the device says it.
struct SensorReading {
  std::uint32_t sensor = 0;  ///< from 0
  /// ok, or `invalid` when the device flags an error or gives numbers that are no pose; then the pose means nothing.
  PoseStatus status = PoseStatus::invalid;
  Pose tracker_from_sensor;                 ///< mm
  std::uint32_t buttons = 0;                ///< as the device numbers them
  std::optional<std::uint32_t> distortion;  ///< as the device grades it; empty of one that does not say
};

/// Sets pose and status from millimetres and a quaternion, which is normalised. `invalid` when a number is not finite,
/// the place is farther than 10 m, or the quaternion's length is off 1 by more than a tenth: rounding to 16 bits leaves
/// 1e-4, and what is that far off is no rotation.
void set_pose(SensorReading& reading, const glm::dvec3& mm, double w, double x, double y, double z);

}  // namespace insonate
