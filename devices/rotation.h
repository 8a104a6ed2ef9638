#pragma once

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <cmath>

// Rotations as rotation vectors: axis times angle, rad.

namespace insonate {

/// Returns the rotation that the rotation vector `rad` describes.
inline glm::dquat rotation_from_vector(const glm::dvec3& rad) {
  const double angle = glm::length(rad);
  return angle > 0 ? glm::angleAxis(angle, rad / angle) : glm::dquat(1, 0, 0, 0);
}

/// Returns the rotation vector of `turn`, along the shorter way (at most pi).
inline glm::dvec3 rotation_vector(glm::dquat turn) {
  if (turn.w < 0) turn = -turn;
  const glm::dvec3 half(turn.x, turn.y, turn.z);
  const double sine = glm::length(half);
  // Near the identity the sine equals the angle, and dividing by it would lose the axis.
  return sine > 1e-12 ? half * (2 * std::atan2(sine, turn.w) / sine) : half * 2.0;
}

}  // namespace insonate
