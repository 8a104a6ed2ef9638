#include "devices/osvr/osvr_report.h"

#include <cmath>

namespace insonate {

Parsed<OsvrReport> parse_osvr(Bytes bytes) {
  Parsed<OsvrReport> parsed;
  // Firmware before version 3 pads the report to 32 bytes.
  if (bytes.size() != 16 && bytes.size() != 32) {
    parsed.fault = ReportFault::length;
    return parsed;
  }
  const int version = bytes[0] & 0x0f;
  if (version < 1 || version > 3) {
    parsed.fault = ReportFault::header;
    return parsed;
  }
  const auto q14 = [&](std::size_t offset) { return i16_at(bytes, offset) / 16384.0; };
  const auto q9 = [&](std::size_t offset) { return i16_at(bytes, offset) / 512.0; };
  const glm::dquat turned(q14(8), q14(2), q14(4), q14(6));
  if (!(std::abs(glm::length(turned) - 1) <= 0.1)) {
    parsed.fault = ReportFault::checksum;
    return parsed;
  }
  parsed.report.sequence = bytes[1];
  parsed.report.world_from_sensor = glm::normalize(turned);
  parsed.report.rad_per_s = {q9(10), q9(12), q9(14)};
  return parsed;
}

}  // namespace insonate
