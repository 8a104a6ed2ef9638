#include "sim/view/mpr_planes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace insonate::view {

MprPlanes::MprPlanes(const Grid& volume) : volume_(volume) {
  reset();
}

void MprPlanes::reset() {
  centre_ = volume_.centre();
  normals_ = volume_.direction;
}

int MprPlanes::axis_of(MprPlane plane) {
  switch (plane) {
    case MprPlane::imaging:
      return 2;
    case MprPlane::side:
      return 0;
    case MprPlane::face:
      break;
  }
  return 1;
}

Pose MprPlanes::frame(MprPlane plane, bool marker_left) const {
  const glm::dvec3 lateral = (marker_left ? -1.0 : 1.0) * volume_.direction[0], depth = volume_.direction[1],
                   elevation = volume_.direction[2];
  const glm::dvec3 down = plane == MprPlane::face ? elevation : depth;
  const glm::dvec3 right = plane == MprPlane::side ? elevation : lateral;
  const glm::dvec3 n = normal(plane);
  const auto within = [&](const glm::dvec3& axis) { return axis - glm::dot(axis, n) * n; };
  // The axis that lies less along the normal is kept upright. The other follows from it, on its own side.
  const bool by_down = glm::length(within(down)) >= 0.5;
  const glm::dvec3 kept = glm::normalize(within(by_down ? down : right));
  glm::dvec3 other = glm::cross(kept, n);
  const glm::dvec3 wanted = by_down ? right : down;
  if (glm::dot(other, wanted) < 0) other = -other;
  const glm::dvec3 x = by_down ? other : kept, y = by_down ? kept : other;
  return {glm::dmat3(x, y, glm::cross(x, y)), centre_};
}

void MprPlanes::move_to(const glm::dvec3& patient_mm) {
  const glm::dvec3 index = volume_.index_from_patient(patient_mm);
  centre_ = volume_.patient_from_index(glm::clamp(index, glm::dvec3(0.0), glm::dvec3(volume_.size - 1)));
}

void MprPlanes::turn(MprPlane plane, double by_deg, bool marker_left) {
  // Clockwise in a picture whose y points down is from x to y, a positive turn about x cross y.
  const glm::dvec3 axis = frame(plane, marker_left).rotation[2];
  const glm::dmat3 turned = glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(by_deg), axis)) * normals_;
  const glm::dvec3 n = normal(plane);
  // Orthonormal again, so that many small turns do not add up to a skew.
  normals_ = pose_from_matrix(glm::dmat4(turned)).rotation;
  normals_[axis_of(plane)] = n;
}

double MprPlanes::turned_deg() const {
  return angle_between_deg({volume_.direction, {}}, {normals_, {}});
}

}  // namespace insonate::view
