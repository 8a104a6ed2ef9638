#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <string>

#include "sim/core/grid.h"
#include "sim/core/pose.h"

namespace insonate::view {

/// The three planes of a multiplanar reformation of a volume.
enum class MprPlane {
  imaging,  ///< across the elevation: shows what the probe showed
  side,     ///< across the lateral axis: depth down, elevation to the right
  face,     ///< across the depth, parallel to the probe's face: a C-plane
};
inline constexpr std::array kMprPlanes{MprPlane::imaging, MprPlane::side, MprPlane::face};

/// Three perpendicular planes through a point of a volume whose axes are i lateral, j into the depth, k along the
/// elevation, and right-handed. Each plane is shown upright as the volume lies, however the others are turned.
class MprPlanes {
public:
  MprPlanes() = default;
  /// Begins in the volume's middle, along its axes.
  explicit MprPlanes(const Grid& volume);

  const glm::dvec3& centre() const { return centre_; }
  /// Returns the unit normal of a plane, in the patient.
  glm::dvec3 normal(MprPlane plane) const { return normals_[axis_of(plane)]; }

  /// Returns the frame of a plane's picture: origin at centre(), x to the right, y down, in the patient.
  /// @param marker_left  whether the lateral axis runs to the left, as where the probe's marker is shown on the left
  Pose frame(MprPlane plane, bool marker_left) const;

  /// Moves the point, patient mm. It stays within the volume's box.
  void move_to(const glm::dvec3& patient_mm);
  /// Moves a plane along its normal, mm.
  void shift(MprPlane plane, double by_mm) { move_to(centre_ + by_mm * normal(plane)); }
  /// Turns the two other planes about this one's normal; clockwise in its picture for positive angles.
  void turn(MprPlane plane, double by_deg, bool marker_left);
  /// Goes back to the volume's middle and axes.
  void reset();

  /// Returns how far the planes are turned from the volume's axes, degrees.
  double turned_deg() const;

  bool operator==(const MprPlanes&) const = default;

private:
  static int axis_of(MprPlane plane);

  Grid volume_;
  glm::dvec3 centre_{0.0};
  glm::dmat3 normals_{1.0};  ///< column c is the normal of the plane across the volume's axis c
};

}  // namespace insonate::view
