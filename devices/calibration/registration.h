#pragma once

#include <glm/vec3.hpp>

#include <span>
#include <string>
#include <vector>

#include "devices/calibration/outcome.h"
#include "sim/core/pose.h"

namespace insonate {

/// A landmark that can be located on the mannequin and in the CT.
struct LandmarkPair {
  std::string name;          ///< in plain words
  glm::dvec3 touched_mm{0};  ///< position where the probe's tip touched it, in the tracker's or the mannequin's frame
  glm::dvec3 ct_mm{0};       ///< position in the CT (LPS)
  bool held_out = false;     ///< not used for the fit: its error is the accuracy
};

/// The fit of the mannequin to the CT, and its errors.
struct Registration {
  Pose ct_from_touched;
  /// RMS distance over the held-out landmarks between their CT positions and those that the fit predicts. The fit does
  /// not use them, so this is the accuracy reported to users. It includes the landmarks' own localisation error.
  double accuracy_mm = 0;
  /// RMS distance over the fitted landmarks. It does not measure accuracy: with few landmarks a fit follows their
  /// errors (Fitzpatrick, "Fiducial registration error and target registration error are uncorrelated", SPIE 7261,
  /// 2009).
  double residual_mm = 0;
  /// The landmark that agrees least with the others, and its distance from where a fit to the others puts it.
  std::string worst;
  double worst_mm = 0;
};

inline constexpr std::size_t kMinLandmarks = 6;  ///< fitted landmarks; at least one more is held out
/// Smallest RMS distance of the landmarks from their best-fitting line and plane.
inline constexpr double kMinOffLine_mm = 30, kMinOffPlane_mm = 10;
/// RMS. Body shapes differ by 20 mm; an error of twice that means that a landmark was mistaken for another.
inline constexpr double kMaxLandmarkResidual_mm = 40;

/// Fits a rigid motion to pairs of landmarks: the least squares solution by unit quaternions (Horn, J. Opt. Soc. Am. A
/// 4, 1987; the same as that of Kabsch, Acta Cryst. A32, 1976), with the scale fixed at 1. With a localisation error of
/// 2 mm, the error at a target among 6 landmarks is 1.0 to 1.2 mm, and among 8 it is 0.9 to 1.0 mm (Fitzpatrick, West
/// and Maurer, IEEE TMI 17, 1998). Refused with fewer than kMinLandmarks to fit or none held out, or if the landmarks
/// lie near a line or a plane. Also refused if a mirrored body fits better, or if the residual shows that landmarks
/// were mixed up.
Outcome<Registration> register_landmarks(std::span<const LandmarkPair> pairs);

}  // namespace insonate
