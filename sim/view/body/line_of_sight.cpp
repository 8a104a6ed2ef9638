#include "sim/view/body/line_of_sight.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace insonate::view {

LineOfSight line_of_sight(const OrbitCamera& camera, const glm::dvec2& pixel, int width, int height) {
  const Pose pose = camera.patient_from_camera();
  const double focal_px = height / 2.0 / std::tan(glm::radians(camera.field_of_view_deg / 2));
  const glm::dvec3 ray((pixel - glm::dvec2(width, height) / 2.0) / focal_px, 1);
  return {pose.translation, glm::normalize(pose.direction(ray))};
}

}  // namespace insonate::view
