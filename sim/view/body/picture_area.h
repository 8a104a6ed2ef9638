#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include <array>
#include <span>
#include <vector>

#include "sim/core/pose.h"
#include "sim/view/body/orbit_camera.h"

namespace insonate::view {

/// A rectangle of a picture's pixels, from `first` to before `end`; row 0 is the top. It may be empty.
struct PictureArea {
  glm::ivec2 first{0}, end{0};
};

/// Returns the pixels in which the convex hull of some points can appear: their bounding rectangle with a pixel more on
/// each side. It is empty without points, and the whole picture if one of them is not in front of the camera.
PictureArea area_of(std::span<const glm::dvec3> points_mm, const OrbitCamera& camera, int width, int height);

/// The corners of a box. Bit i of an index is set if the corner lies at the far end of axis i.
using BoxCorners = std::array<glm::dvec3, 8>;

/// Returns the corners in patient mm of the box that a matrix maps to 0 to 1 along each axis.
BoxCorners corners_of(const glm::dmat4& box_from_patient);

/// Returns the corners of the polygon in which a plane (x and y of a pose) cuts a box, in any order; none if they miss
/// each other.
std::vector<glm::dvec3> cut_through(const BoxCorners& box, const Pose& patient_from_plane);

}  // namespace insonate::view
