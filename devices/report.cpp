#include "devices/report.h"

#include <glm/gtc/quaternion.hpp>

#include <cmath>

namespace insonate {

std::string_view to_string(ReportFault fault) {
  switch (fault) {
    case ReportFault::none:
      return "none";
    case ReportFault::length:
      return "length";
    case ReportFault::header:
      return "header";
    case ReportFault::checksum:
      return "checksum";
  }
  return "none";
}

void set_pose(SensorReading& reading, const glm::dvec3& mm, double w, double x, double y, double z) {
  reading.status = PoseStatus::invalid;
  const double length = std::sqrt(w * w + x * x + y * y + z * z);
  // Written so that NaN fails.
  if (!(std::abs(length - 1) <= 0.1) || !(glm::length(mm) <= 1e4)) return;
  reading.status = PoseStatus::ok;
  reading.tracker_from_sensor = {glm::mat3_cast(glm::dquat(w / length, x / length, y / length, z / length)), mm};
}

}  // namespace insonate
