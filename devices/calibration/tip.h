#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>

#include "devices/calibration/outcome.h"
#include "sim/core/pose.h"

namespace insonate {

/// Where the pointed tip of the probe lies, found by pivoting: the tip rests in a dimple while the probe is tilted and
/// turned about it.
struct TipFit {
  glm::dvec3 tip_mm{0};    ///< in the sensor's frame
  glm::dvec3 pivot_mm{0};  ///< of the dimple, in the tracker's frame
  /// RMS distance between the dimple and where the kept poses put the tip. It holds the tracker's noise and the tip's
  /// play in the dimple; a scale error of the tracker hides from it.
  double residual_mm = 0;
  /// Standard deviation of the tip along the direction that is known worst, if the residuals of the poses were
  /// independent. Poses that follow each other closely are not: take it for a lower bound.
  double tip_sd_mm = 0;
  /// How far the probe was turned: the RMS angle by which the direction that turned least was turned.
  double spread_deg = 0;
  std::size_t used = 0;      ///< poses that the fit rests on
  std::size_t rejected = 0;  ///< poses that disagreed with it
};

/// Below that noise grows more than sixfold on its way to the tip (tip_sd_mm). Tilting by 14 degrees to all sides
/// gives 10.
inline constexpr double kLeastPivotSpreadDeg = 10;
inline constexpr std::size_t kLeastPivotPoses = 50;
/// Static noise of magnetic trackers is 0.08 to 0.3 mm (DEVICES): ten times that is no tip in a dimple.
inline constexpr double kMostPivotResidualMm = 3;
/// Outliers beyond that share were no accidents.
inline constexpr double kMostPivotRejected = 0.35;

/// How far poses were turned against each other, as TipFit::spread_deg; 0 without any. From 0 to 90.
double pivot_spread_deg(std::span<const Pose> tracker_from_sensor);

/// Fits a tip to poses tracker_from_sensor (mm): the least squares solution of R_i tip + p_i = pivot over all i, the
/// "algebraic one step" of Yaniv, "Which pivot calibration?", SPIE 9415 (2015). Outliers are found by the least median
/// of squares (Rousseeuw, J. Am. Stat. Assoc. 79, 1984) over subsets of three poses, so that up to kMostPivotRejected
/// of the poses may be anything. Refused when there are fewer than kLeastPivotPoses, when the rotations do not span
/// enough to tell the tip, when too many poses are rejected, or when the residual is too large. The same poses give the
/// same fit to the bit.
Outcome<TipFit> fit_tip(std::span<const Pose> tracker_from_sensor);

}  // namespace insonate
