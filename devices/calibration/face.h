#pragma once

#include <glm/vec3.hpp>

#include "devices/calibration/outcome.h"
#include "sim/core/pose.h"

namespace insonate {

/// Four points of the probe in the sensor's frame, mm, read from its drawing or touched.
struct FacePoints {
  glm::dvec3 middle{0};      ///< middle of the face, where the central beam leaves it
  glm::dvec3 marker_end{0};  ///< end of the face on the marker's side
  glm::dvec3 other_end{0};   ///< the other end of the face
  glm::dvec3 tail{0};        ///< on the probe's axis at its far end: where the cable leaves a straight handle
};

/// The face's frame in the sensor's, and the quality of its four points.
struct FaceFit {
  Pose sensor_from_face;  ///< the face's frame is the probe's of sim/core/pose.h
  /// Deviation of the angle between the face and the probe's axis from 90 degrees. It estimates the error of the four
  /// points. It does not show a common shift of all points.
  double skew_deg = 0;
  double off_middle_mm = 0;  ///< distance of the middle from the midpoint of the ends, along the face
};

inline constexpr double kMaxSkew_deg = 10, kMaxOffMiddle_mm = 5;
inline constexpr double kMinFace_mm = 8, kMinHandle_mm = 40;

/// Computes the frame of the face. +y runs from the tail to the middle, because that is the longer and so the more
/// accurate distance. +x runs from the other end to the marker's, made perpendicular to +y. Refused if points are too
/// close together, or if skew_deg or off_middle_mm exceeds its limit.
Outcome<FaceFit> fit_face(const FacePoints& points);

}  // namespace insonate
