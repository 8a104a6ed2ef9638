#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <string>

namespace insonate {

/// A rigid transform in double precision; lengths in mm.
///
/// Named after what it maps, right to left: `patient_from_probe` takes a point given in the probe's frame to the
/// patient's, and chains as `patient_from_tracker * tracker_from_probe`. The patient's frame is LPS (+x to the
/// patient's left, +y to the back, +z to the head), as in DICOM and ITK. The probe's frame has its origin at the middle
/// of the transducer's face, +x lateral towards the marker, +y along the central beam away from the face, and
/// +z = x cross y along the elevation.
struct Pose {
  glm::dmat3 rotation{1.0};     ///< proper and orthonormal; column c is the image of axis c
  glm::dvec3 translation{0.0};  ///< mm

  glm::dvec3 point(const glm::dvec3& p) const { return rotation * p + translation; }
  glm::dvec3 direction(const glm::dvec3& d) const { return rotation * d; }
  Pose inverse() const;
  glm::dmat4 matrix() const;
  bool operator==(const Pose&) const = default;
};

Pose operator*(const Pose& a_from_b, const Pose& b_from_c);

/// Beyond that no tracker reaches.
inline constexpr double kTrackerReachMm = 1e5;

/// The largest entry of |R^T R - 1| that rounding to 6 decimals leaves, with a margin.
inline constexpr double kRoundingToSixDecimals = 2e-4;

/// How far a matrix is from a rotation: the largest entry of |R^T R - 1|, 0 for a rotation.
double orthonormal_error(const glm::dmat3& rotation);

/// Why `matrix` is not a rigid transform in mm, as the problem part of an InputError ("the rotation mirrors: its
/// determinant is -1"); empty when it is one. Accepts an orthonormal_error() up to `largest_error`, the last row
/// (0 0 0 1), and a translation up to `reach_mm`.
std::optional<std::string> why_not_rigid(const glm::dmat4& matrix, double reach_mm = kTrackerReachMm,
                                         double largest_error = kRoundingToSixDecimals);

/// The pose of a matrix that why_not_rigid() accepts. A matrix that is orthonormal to double precision is kept to the
/// bit, so that a pose written with 17 digits reads back equal. Up to kRoundingToSixDecimals the rotation is that of
/// the matrix's quaternion, beyond that the nearest one (least squares, from the polar decomposition).
Pose pose_from_matrix(const glm::dmat4& matrix);

/// The angle of the rotation that takes one pose's axes to the other's, in degrees from 0 to 180.
double angle_between_deg(const Pose& a, const Pose& b);

/// On the way from `a` (t = 0) to `b` (t = 1): the translation straight, the rotation by slerp the shorter way round.
Pose interpolate(const Pose& a, const Pose& b, double t);

}  // namespace insonate
