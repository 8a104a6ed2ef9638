#pragma once

#include <glm/vec3.hpp>

#include "devices/calibration/outcome.h"
#include "sim/core/pose.h"

namespace insonate {

/// Four points of the probe, mm, in the sensor's frame: read from its drawing or touched.
struct FacePoints {
  glm::dvec3 middle{0};      ///< of the face, where the central beam leaves it
  glm::dvec3 marker_end{0};  ///< end of the face on the marker's side
  glm::dvec3 other_end{0};   ///< the face's other end
  glm::dvec3 tail{0};        ///< on the probe's axis at its far end: where the cable leaves a straight handle
};

struct FaceFit {
  Pose sensor_from_face;  ///< the face's frame is the probe's of sim/core/pose.h
  /// By how much the face and the probe's axis miss the right angle: what the four points say of their own error. A
  /// shift of all points alike hides from it.
  double skew_deg = 0;
  double off_middle_mm = 0;  ///< how far the middle lies to one side of the ends' middle, along the face
};

inline constexpr double kMostSkewDeg = 10, kMostOffMiddleMm = 5;
inline constexpr double kLeastFaceMm = 8, kLeastHandleMm = 40;

/// The face's frame through the points: +y from the tail to the middle, the longer arm and so the surer, +x from the
/// other end to the marker's as nearly as the right angle allows. Refused when points lie too close together, or when
/// skew or off-middle are above their limits.
Outcome<FaceFit> fit_face(const FacePoints& points);

}  // namespace insonate
