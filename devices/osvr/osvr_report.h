#pragma once

#include <glm/gtc/quaternion.hpp>

#include "devices/report.h"

namespace insonate {

/// The input report of an OSVR HDK's head tracker, about 400 times a second: orientation, no place.
struct OsvrReport {
  std::uint8_t sequence = 0;  ///< of the device, one more with each report, modulo 256
  glm::dquat world_from_sensor{1, 0, 0,
                               0};  ///< unit; which way the world's horizontal axes point is the device's affair
  glm::dvec3 rad_per_s{0};          ///< angular velocity in the sensor's frame
};

/// A quaternion that is no rotation has the fault `checksum`: it is the only check that the report allows.
Parsed<OsvrReport> parse_osvr(Bytes bytes);

}  // namespace insonate
