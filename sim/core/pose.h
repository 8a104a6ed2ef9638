#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <string>

namespace insonate {

/// A rigid transform in double precision; lengths in mm.
///
/// A pose is named after the frames it maps, from right to left: `patient_from_probe` maps a point in the probe's frame
/// to the patient's, and chains as `patient_from_tracker * tracker_from_probe`. The patient's frame is LPS (+x to the
/// patient's left, +y to the back, +z to the head), as in DICOM and ITK. The probe's frame has its origin at the middle
/// of the transducer's face, +x lateral towards the marker, +y along the central beam away from the face, and +z = x
/// cross y along the elevation.
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

/// The longest translation accepted from a tracker, mm; no tracker's range is larger.
inline constexpr double kTrackerRange_mm = 1e5;

/// The largest entry of |R^T R - 1| that rounding to 6 decimals causes, with a margin.
inline constexpr double kRoundingToSixDecimals = 2e-4;

/// Returns how far a matrix is from a rotation: the largest entry of |R^T R - 1|, 0 for a rotation.
double orthonormal_error(const glm::dmat3& rotation);

/// Returns why `matrix` is not a rigid transform in mm, as the problem part of an InputError ("the rotation mirrors:
/// its determinant is -1"). Returns nothing if it is one. Accepts an orthonormal_error() up to `largest_error`, the
/// last row (0 0 0 1), and a translation up to `reach_mm`.
std::optional<std::string> why_not_rigid(const glm::dmat4& matrix, double reach_mm = kTrackerRange_mm,
                                         double largest_error = kRoundingToSixDecimals);

/// Returns the pose of a matrix that why_not_rigid() accepts. A matrix that is orthonormal to double precision keeps
/// every bit, so that a pose written with 17 digits reads back equal. Up to kRoundingToSixDecimals the rotation is that
/// of the matrix's quaternion; beyond that it is the nearest rotation (least squares, from the polar decomposition).
Pose pose_from_matrix(const glm::dmat4& matrix);

/// Returns the angle of the rotation from one pose's axes to the other's, in degrees from 0 to 180.
double angle_between_deg(const Pose& a, const Pose& b);

/// Returns the pose between `a` (t = 0) and `b` (t = 1): the translation is linear, the rotation follows slerp on the
/// shorter arc.
Pose interpolate(const Pose& a, const Pose& b, double t);

}  // namespace insonate
