#pragma once

#include <glm/gtc/quaternion.hpp>

#include "devices/report.h"

namespace insonate {

/// The input report of an OSVR HDK's head tracker, about 400 times per second: orientation, but no position.
struct OsvrReport {
  std::uint8_t sequence = 0;                 ///< numbered by the device: one more with each report, modulo 256
  glm::dquat world_from_sensor{1, 0, 0, 0};  ///< unit; the device chooses the direction of the world's horizontal axes
  glm::dvec3 rad_per_s{0};                   ///< angular velocity in the sensor's frame
};

/// Parses a report. A quaternion that is not a rotation has the fault `checksum`: it is the only check that the report
/// allows.
Parsed<OsvrReport> parse_osvr(Bytes bytes);

}  // namespace insonate
