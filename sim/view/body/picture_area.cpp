#include "sim/view/body/picture_area.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <limits>

namespace insonate::view {
namespace {

constexpr double kNearest_mm = 1;

}  // namespace

PictureArea area_of(std::span<const glm::dvec3> points_mm, const OrbitCamera& camera, int width, int height) {
  if (points_mm.empty()) return {};
  const Pose camera_from_patient = camera.patient_from_camera().inverse();
  const auto is_behind = [&](const glm::dvec3& p) { return camera_from_patient.point(p).z < kNearest_mm; };
  const glm::dvec2 size(width, height);
  if (std::ranges::any_of(points_mm, is_behind)) return {{0, 0}, {width, height}};
  glm::dvec2 least(std::numeric_limits<double>::infinity()), most = -least;
  for (const glm::dvec3& point : points_mm) {
    const glm::dvec2 at = camera.project(point, width, height);
    least = glm::min(least, at);
    most = glm::max(most, at);
  }
  return {glm::ivec2(glm::clamp(glm::floor(least) - 1.0, glm::dvec2(0.0), size)),
          glm::ivec2(glm::clamp(glm::ceil(most) + 1.0, glm::dvec2(0.0), size))};
}

BoxCorners corners_of(const glm::dmat4& box_from_patient) {
  const glm::dmat4 patient_from_box = glm::inverse(box_from_patient);
  BoxCorners corners;
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i] = glm::dvec3(patient_from_box * glm::dvec4(i & 1, i >> 1 & 1, i >> 2 & 1, 1));
  return corners;
}

std::vector<glm::dvec3> cut_through(const BoxCorners& box, const Pose& patient_from_plane) {
  const Pose plane_from_patient = patient_from_plane.inverse();
  std::vector<glm::dvec3> cut;
  for (std::size_t a = 0; a < box.size(); ++a)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t b = a | std::size_t(1) << axis;
      if (a == b) continue;
      const double from = plane_from_patient.point(box[a]).z, to = plane_from_patient.point(box[b]).z;
      if ((from < 0) != (to < 0)) cut.push_back(glm::mix(box[a], box[b], from / (from - to)));
    }
  return cut;
}

}  // namespace insonate::view
