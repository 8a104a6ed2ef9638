#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>

#include "devices/calibration/outcome.h"
#include "sim/core/pose.h"

namespace insonate {

/// Position of the probe's pointed tip, found by pivoting: the tip rests in a dimple while the probe is tilted and
/// rotated about it.
struct TipFit {
  glm::dvec3 tip_mm{0};    ///< in the sensor's frame
  glm::dvec3 pivot_mm{0};  ///< position of the dimple, in the tracker's frame
  /// RMS distance between the dimple and the tip in the poses that were used. It includes the tracker's noise and the
  /// tip's play in the dimple. It does not show a scale error of the tracker.
  double residual_mm = 0;
  /// Standard deviation of the tip along its least certain direction, assuming that the residuals of the poses are
  /// independent. Poses in quick succession are not independent, so it is a lower bound.
  double tip_sd_mm = 0;
  /// How far the probe was rotated: the RMS rotation angle of the direction that was rotated least.
  double spread_deg = 0;
  std::size_t used = 0;      ///< poses used for the fit
  std::size_t rejected = 0;  ///< poses rejected as outliers
};

/// Below this, noise grows more than sixfold on its way to the tip (tip_sd_mm). Tilting by 14 degrees to all sides
/// gives 10.
inline constexpr double kMinPivotSpread_deg = 10;
/// What a person is asked for. It is more than enough for the least spread, which is a mean over the directions.
inline constexpr int kPivotTilt_deg = 30;
inline constexpr std::size_t kMinPivotPoses = 50;
/// Static noise of magnetic trackers is 0.08 to 0.3 mm where no metal is near: with ten times that, the tip was not in
/// a dimple.
inline constexpr double kMaxPivotResidual_mm = 3;
/// A larger fraction of outliers is not accidental.
inline constexpr double kMaxPivotRejected = 0.35;

/// Returns how far the poses were rotated relative to each other, as TipFit::spread_deg, from 0 to 90; 0 without poses.
double pivot_spread_deg(std::span<const Pose> tracker_from_sensor);

/// Fits a tip to poses tracker_from_sensor (mm): the least squares solution of R_i tip + p_i = pivot over all i, the
/// "algebraic one step" of Yaniv, "Which pivot calibration?", SPIE 9415 (2015). Outliers are found by the least median
/// of squares (Rousseeuw, J. Am. Stat. Assoc. 79, 1984) over subsets of three poses, so up to kMaxPivotRejected of the
/// poses may be arbitrary. Refused with fewer than kMinPivotPoses, if the rotations do not span enough to determine
/// the tip, if too many poses are rejected, or if the residual is too large. The same poses give the same fit, bit for
/// bit.
Outcome<TipFit> fit_tip(std::span<const Pose> tracker_from_sensor);

}  // namespace insonate
