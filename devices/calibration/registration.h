#pragma once

#include <glm/vec3.hpp>

#include <span>
#include <string>
#include <vector>

#include "devices/calibration/outcome.h"
#include "sim/core/pose.h"

namespace insonate {

/// A place that can be found on the mannequin and in the CT.
struct LandmarkPair {
  std::string name;          ///< as people say it
  glm::dvec3 touched_mm{0};  ///< where the probe's tip touched it, in the tracker's or the mannequin's frame
  glm::dvec3 ct_mm{0};       ///< where it is in the CT (LPS)
  bool held_out = false;     ///< not used for the fit: its error is the accuracy
};

struct Registration {
  Pose ct_from_touched;
  /// RMS distance over the held-out landmarks between where they are in the CT and where the fit puts them: an error
  /// the fit knows nothing of, and so what a person is told. It holds the landmark's own localisation error too.
  double accuracy_mm = 0;
  /// RMS distance over the fitted landmarks. No measure of accuracy: with few landmarks a fit follows their errors
  /// (Fitzpatrick, "Fiducial registration error and target registration error are uncorrelated", SPIE 7261, 2009).
  double residual_mm = 0;
  /// The landmark that the others agree with least, and how far they put it elsewhere.
  std::string worst;
  double worst_mm = 0;
};

inline constexpr std::size_t kLeastLandmarks = 6;  ///< that are fitted; one more is held out
/// Landmarks have to spread by that RMS distance from their best line, and from their best plane.
inline constexpr double kLeastOffLineMm = 30, kLeastOffPlaneMm = 10;
/// RMS. Body shapes differ by 20 mm; twice that is a landmark taken for another.
inline constexpr double kMostLandmarkResidualMm = 40;

/// Fits a rigid motion to pairs of landmarks: the least squares solution by unit quaternions (Horn, J. Opt. Soc. Am. A
/// 4, 1987; the same as that of Kabsch, Acta Cryst. A32, 1976), the scale fixed at 1. With a localisation error of 2 mm
/// the error at a target among the landmarks is 1.0 to 1.2 mm for 6 of them, 0.9 to 1.0 for 8 (Fitzpatrick, West and
/// Maurer, IEEE TMI 17, 1998). Refused with fewer than kLeastLandmarks to fit or none held out, when they lie near a
/// line or a plane, when a mirrored body would fit better, and when the residual says that landmarks are mixed up.
Outcome<Registration> register_landmarks(std::span<const LandmarkPair> pairs);

}  // namespace insonate
