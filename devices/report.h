#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "devices/bytes.h"
#include "sim/core/probe_sample.h"

namespace insonate {

/// Why a parser refused the bytes of a report.
enum class ReportFault {
  none,
  length,    ///< shorter or longer than a report of this kind
  header,    ///< does not begin like a report of this kind
  checksum,  ///< the report's own checksum does not match
};

std::string_view to_string(ReportFault fault);

/// Result of parsing a report's bytes. `report` is meaningful only if there is no fault.
template <typename Report>
struct Parsed {
  ReportFault fault = ReportFault::none;
  Report report;
};

/// Reading of one sensor that measures position and orientation, in the tracker's own frame and as the device reports
/// it.
struct SensorReading {
  std::uint32_t sensor = 0;  ///< from 0
  /// ok, or `invalid` if the device flags an error or its numbers are not a pose. In that case the pose is meaningless.
  PoseStatus status = PoseStatus::invalid;
  Pose tracker_from_sensor;                 ///< mm
  std::uint32_t buttons = 0;                ///< numbered as the device numbers them
  std::optional<std::uint32_t> distortion;  ///< the device's own grade; empty if it reports none
};

/// Sets pose and status from a position in millimetres and a quaternion, which is normalised. The status is `invalid`
/// if a number is not finite, if the position is farther than 10 m, or if the quaternion's length differs from 1 by
/// more than 0.1. Rounding to 16 bits leaves an error of 1e-4, so a larger difference means that it is not a rotation.
void set_pose(SensorReading& reading, const glm::dvec3& mm, double w, double x, double y, double z);

}  // namespace insonate
