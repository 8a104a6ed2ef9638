#include "sim/core/pose.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

#include "sim/core/text.h"

namespace insonate {

namespace {

constexpr double kLastRowTolerance = 1e-4;
constexpr double kSingular = 1e-4;

// Far above the rounding of a few products in double precision, far below that of six decimals.
constexpr double kRoundingError = 1e-12;

// Newton's iteration for the polar decomposition (Higham, SIAM J. Sci. Stat. Comput. 7, 1986). Its error squares with
// each iteration, so that from 2e-3 four iterations reach double precision.
glm::dmat3 nearest_rotation(glm::dmat3 matrix) {
  for (int round = 0; round < 4; ++round) matrix = 0.5 * (matrix + glm::transpose(glm::inverse(matrix)));
  return matrix;
}

}  // namespace

Pose Pose::inverse() const {
  const glm::dmat3 back = glm::transpose(rotation);
  return {back, -(back * translation)};
}

glm::dmat4 Pose::matrix() const {
  glm::dmat4 m(rotation);
  m[3] = glm::dvec4(translation, 1.0);
  return m;
}

Pose operator*(const Pose& a_from_b, const Pose& b_from_c) {
  return {a_from_b.rotation * b_from_c.rotation, a_from_b.point(b_from_c.translation)};
}

double orthonormal_error(const glm::dmat3& rotation) {
  const glm::dmat3 excess = glm::transpose(rotation) * rotation - glm::dmat3(1.0);
  double largest = 0;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) largest = std::max(largest, std::abs(excess[c][r]));
  return largest;
}

/// Returns which of a matrix's columns are not those of a rotation, and by how much.
std::string how_not_orthonormal(const glm::dmat3& m) {
  const glm::dvec3 lengths(glm::length(m[0]), glm::length(m[1]), glm::length(m[2]));
  double stretch = 0, skew = 0;
  for (int c = 0; c < 3; ++c) {
    stretch = std::max(stretch, std::abs(lengths[c] - 1));
    const int next = (c + 1) % 3;
    skew = std::max(skew, std::abs(glm::dot(m[c], m[next])) / (lengths[c] * lengths[next]));
  }
  if (stretch >= skew)
    return formatted("its columns are %.5g, %.5g and %.5g long, not 1", lengths.x, lengths.y, lengths.z);
  return formatted("two of its columns are %.3g degrees off a right angle",
                   glm::degrees(std::asin(std::min(skew, 1.0))));
}

std::optional<std::string> why_not_rigid(const glm::dmat4& m, double reach_mm, double largest_error) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(m[c][r])) return "the matrix holds a number that is not finite";
  const glm::dvec4 last_row(m[0][3], m[1][3], m[2][3], m[3][3]);
  if (glm::length(last_row - glm::dvec4(0, 0, 0, 1)) > kLastRowTolerance) return "the matrix's last row is not 0 0 0 1";

  const glm::dmat3 rotation(m);
  const double determinant = glm::determinant(rotation);
  if (std::abs(determinant) < kSingular)
    return formatted("the rotation is singular: its determinant is %g", determinant);
  if (determinant < 0) return formatted("the rotation mirrors: its determinant is %g", determinant);
  if (orthonormal_error(rotation) > largest_error)
    return "the rotation is not orthonormal: " + how_not_orthonormal(rotation);
  const double length = glm::length(glm::dvec3(m[3]));
  if (length > reach_mm) return formatted("the translation is %g mm long, further than anything reaches", length);
  return std::nullopt;
}

Pose pose_from_matrix(const glm::dmat4& m) {
  if (orthonormal_error(glm::dmat3(m)) < kRoundingError) return {glm::dmat3(m), glm::dvec3(m[3])};
  const glm::dmat3 rotation(m);
  // Keep this path: the scores of stored recordings depend on its last bits.
  if (orthonormal_error(rotation) <= kRoundingToSixDecimals)
    return {glm::mat3_cast(glm::normalize(glm::quat_cast(rotation))), glm::dvec3(m[3])};
  return {nearest_rotation(rotation), glm::dvec3(m[3])};
}

double angle_between_deg(const Pose& a, const Pose& b) {
  const glm::dmat3 turn = glm::transpose(a.rotation) * b.rotation;
  // The sine comes from the skew part and the cosine from the trace: acos alone loses half its digits near 0.
  const glm::dvec3 axis(turn[1][2] - turn[2][1], turn[2][0] - turn[0][2], turn[0][1] - turn[1][0]);
  return glm::degrees(std::atan2(glm::length(axis) / 2, (turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2));
}

Pose interpolate(const Pose& a, const Pose& b, double t) {
  const glm::dquat turn = glm::slerp(glm::quat_cast(a.rotation), glm::quat_cast(b.rotation), t);
  return {glm::mat3_cast(turn), glm::mix(a.translation, b.translation, t)};
}

}  // namespace insonate
