#pragma once

#include "sim/view/body/orbit_camera.h"

namespace insonate::view {

struct LineOfSight {
  glm::dvec3 eye;        ///< patient, mm
  glm::dvec3 direction;  ///< patient, unit
};

/// Returns the line through a point of a camera's picture, in pixels from the top left corner. Undoes
/// OrbitCamera::project().
LineOfSight line_of_sight(const OrbitCamera& camera, const glm::dvec2& pixel, int width, int height);

}  // namespace insonate::view
