#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace insonate {

/// What a registration may change.
enum class Freedom {
  rigid,   ///< 3 translations and 3 rotations
  affine,  ///< 3 stretches and 3 shears too
};

/// Returns the number of parameters: 6 or 12.
constexpr std::size_t parameters_of(Freedom freedom) {
  return freedom == Freedom::rigid ? 6 : 12;
}

/// Turns the parameters of a registration into maps. All parameters are in mm: a rotation or stretch counts as the
/// distance that it moves a point at `radius_mm` from the centre. So they are of one scale and, about the centre of the
/// sweep, hardly depend on each other.
struct Motion {
  glm::dmat4 ct_from_sweep{1.0};  ///< with all parameters 0
  glm::dvec3 centre_in_ct{0.0};   ///< what turns and stretches leave where it is, mm
  double radius_mm = 50;          ///< above 0

  /// Returns T(x0..2) R(x3..5) exp(S(x6..11)) about the centre, behind ct_from_sweep. S is symmetric: its diagonal is
  /// x6..8, and x9..11 are its entries yz, xz and xy.
  /// @param parameters  as many as parameters_of() gives for a freedom; otherwise it throws std::invalid_argument
  glm::dmat4 at(std::span<const double> parameters) const;
};

/// Returns the motion about the middle of points.
/// @param points  in the sweep's frame, at least one
Motion motion_about(const std::vector<glm::dvec3>& points, const glm::dmat4& ct_from_sweep);

}  // namespace insonate
