#include "devices/calibration/tip.h"

#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <vector>

#include "devices/calibration/eigen_glm.h"
#include "sim/core/hash.h"

namespace insonate {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct PivotFit {
  glm::dvec3 tip{0}, pivot{0};
  double least_turn = 0;  ///< smallest RMS displacement of any unit vector under the rotations
};

// Relative to the means of rotations and positions, the pivot drops out of the least squares. What remains is M tip =
// -m with M = mean((R - Rm)^T (R - Rm)) and m = mean((R - Rm)^T (p - pm)). The smallest eigenvalue of M shows how well
// the rotations span.
template <typename Poses>
PivotFit least_squares(const Poses& poses) {
  Eigen::Matrix3d mean_rotation = Eigen::Matrix3d::Zero();
  Eigen::Vector3d mean_position = Eigen::Vector3d::Zero();
  for (const Pose& pose : poses) {
    mean_rotation += eigen(pose.rotation) / double(poses.size());
    mean_position += eigen(pose.translation) / double(poses.size());
  }
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Pose& pose : poses) {
    const Eigen::Matrix3d turned = eigen(pose.rotation) - mean_rotation;
    moment += turned.transpose() * turned / double(poses.size());
    right -= turned.transpose() * (eigen(pose.translation) - mean_position) / double(poses.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moment);
  PivotFit fit;
  fit.least_turn = std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
  if (fit.least_turn < 1e-9) return fit;
  const Eigen::Vector3d tip =
      solver.eigenvectors() * (solver.eigenvectors().transpose() * right).cwiseQuotient(solver.eigenvalues());
  fit.tip = from_eigen(tip);
  fit.pivot = from_eigen(Eigen::Vector3d(mean_rotation * tip + mean_position));
  return fit;
}

double distance_mm(const PivotFit& fit, const Pose& pose) {
  return glm::distance(pose.point(fit.tip), fit.pivot);
}

double degrees_of(double turn) {
  return std::asin(std::min(turn, 1.0)) * 180 / kPi;
}

// Returns the fit to three poses that has the smallest median distance over all poses.
PivotFit least_median(std::span<const Pose> poses, double& least_mm) {
  constexpr std::uint32_t kTrials = 300;
  constexpr std::size_t kJudged = 1000;
  const std::size_t stride = (poses.size() + kJudged - 1) / kJudged;
  PivotFit best;
  least_mm = std::numeric_limits<double>::infinity();
  std::vector<double> distances;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    std::array<Pose, 3> three;
    for (std::uint32_t i = 0; i < 3; ++i) three[i] = poses[hash(trial, i) % poses.size()];
    const PivotFit fit = least_squares(three);
    // Three poses close together determine nothing, and could win among other such triples.
    if (degrees_of(fit.least_turn) < kMinPivotSpread_deg / 2) continue;
    distances.clear();
    for (std::size_t i = 0; i < poses.size(); i += stride) distances.push_back(distance_mm(fit, poses[i]));
    const auto middle = distances.begin() + std::ptrdiff_t(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    if (*middle >= least_mm) continue;
    least_mm = *middle;
    best = fit;
  }
  return best;
}

Refusal turned_too_little(double deg) {
  char text[160];
  std::snprintf(
      text, sizeof text,
      "The probe was turned by %.0f %% of what is needed; tilt it by %d degrees to all sides and turn it about "
      "its length as well.",
      std::floor(100 * deg / kMinPivotSpread_deg), kPivotTilt_deg);
  return {text};
}

}  // namespace

double pivot_spread_deg(std::span<const Pose> tracker_from_sensor) {
  return tracker_from_sensor.empty() ? 0 : degrees_of(least_squares(tracker_from_sensor).least_turn);
}

Outcome<TipFit> fit_tip(std::span<const Pose> poses) {
  if (poses.size() < kMinPivotPoses)
    return Refusal{"Only " + std::to_string(poses.size()) +
                   " poses came; pivot for ten seconds where the tracker sees the sensor."};
  const double spread_deg = pivot_spread_deg(poses);
  if (spread_deg < kMinPivotSpread_deg) return turned_too_little(spread_deg);
  double median_mm = 0;
  PivotFit fit = least_median(poses, median_mm);
  if (!std::isfinite(median_mm)) return turned_too_little(spread_deg);

  // For noise with standard deviation s along each axis, the median distance is 1.538 s, and 99 % are within 3.368 s
  // (chi distribution with three degrees of freedom). The floor is for poses without noise.
  std::vector<Pose> kept;
  double sigma_mm = median_mm / 1.538;
  for (int round = 0; round < 3; ++round) {
    const double limit_mm = std::max(3.368 * sigma_mm, 1e-6);
    kept.clear();
    for (const Pose& pose : poses)
      if (distance_mm(fit, pose) <= limit_mm) kept.push_back(pose);
    if (kept.size() < kMinPivotPoses / 2) break;
    fit = least_squares(kept);
    double squares = 0;
    for (const Pose& pose : kept) squares += std::pow(distance_mm(fit, pose), 2);
    sigma_mm = std::sqrt(squares / double(3 * kept.size()));
  }

  TipFit found;
  found.tip_mm = fit.tip;
  found.pivot_mm = fit.pivot;
  found.used = kept.size();
  found.rejected = poses.size() - kept.size();
  found.residual_mm = std::sqrt(3.0) * sigma_mm;
  found.spread_deg = degrees_of(fit.least_turn);
  char text[200];
  if (double(found.rejected) > kMaxPivotRejected * double(poses.size())) {
    std::snprintf(
        text, sizeof text,
        "%.0f %% of the poses put the tip elsewhere; keep it in the dimple, away from metal, and pivot again.",
        100 * double(found.rejected) / double(poses.size()));
    return Refusal{text};
  }
  if (found.spread_deg < kMinPivotSpread_deg) return turned_too_little(found.spread_deg);
  if (found.residual_mm > kMaxPivotResidual_mm) {
    std::snprintf(text, sizeof text,
                  "The tip strayed by %.1f mm from the dimple; keep it in, away from metal, and pivot again.",
                  found.residual_mm);
    return Refusal{text};
  }
  found.tip_sd_mm = sigma_mm / (std::sqrt(double(found.used)) * fit.least_turn);
  return found;
}

}  // namespace insonate
