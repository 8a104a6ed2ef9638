#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "sim/core/grid.h"
#include "sim/core/pose.h"

namespace insonate::view {

/// The sides that a patient is usually looked at from.
enum class Side { front, back, right, left, head, feet };

/// A perspective camera that circles a point of the patient and keeps the head up.
struct OrbitCamera {
  glm::dvec3 centre{0.0};         ///< the point at the picture's middle, patient mm
  double yaw_deg = 0;             ///< 0 from the front, 90 from the patient's left, 180 from behind
  double pitch_deg = 0;           ///< -89 (from the feet) to 89 (from the head)
  double distance_mm = 900;       ///< distance from the centre, > 0
  double field_of_view_deg = 30;  ///< angle over the picture's height, 5 to 120

  /// Returns a camera that sees the whole volume from the front, a little from the patient's left and from the feet.
  static OrbitCamera framing(const Grid& volume);

  /// Returns a camera with a good view of the probe's plane: at most 35 degrees off its normal, on the side nearer to
  /// the patient's front and feet. Body, probe and a picture of usual depth fill a picture of that width per height.
  static OrbitCamera facing(const Grid& volume, const Pose& patient_from_probe, double aspect = 1);

  /// Returns a camera that sees the whole volume from one side, with the head up. From the feet the patient's front is
  /// up, as in an axial CT slice; from the head it is down.
  static OrbitCamera from(Side side, const Grid& volume);

  /// Returns the camera's pose: x to the right of the picture, y down, z into it. The orientation cue uses its
  /// rotation.
  Pose patient_from_camera() const;

  /// Returns where a patient point appears in a picture, in pixels. (0, 0) is the top left corner, and whole numbers
  /// are edges of pixels. Valid for points in front of the camera.
  glm::dvec2 project(const glm::dvec3& patient_mm, int width, int height) const;

  /// Orbits for a drag: the patient rotates as if held at the pointer.
  void orbit(double yaw_by_deg, double pitch_by_deg);
  /// Pans for a drag by pixels in a picture of that height: the points at the centre's depth follow the pointer.
  void pan(const glm::dvec2& by_px, int height);
  /// Divides the distance by `factor`: above 1 moves nearer. The distance stays within 50 mm and 5 m.
  void zoom(double factor);

  bool operator==(const OrbitCamera&) const = default;
};

}  // namespace insonate::view
