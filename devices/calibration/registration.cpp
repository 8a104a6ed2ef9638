#include "devices/calibration/registration.h"

#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "devices/calibration/eigen_glm.h"

namespace insonate {
namespace {

using Points = std::vector<glm::dvec3>;

struct RigidFit {
  Pose to_from;
  bool mirrored = false;  ///< a reflection would fit better
};

glm::dvec3 centre_of(const Points& points) {
  glm::dvec3 sum(0);
  for (const glm::dvec3& point : points) sum += point;
  return sum / double(points.size());
}

/// Returns the sum of b a^T over points relative to their centroids.
Eigen::Matrix3d moment_of(const Points& b, const Points& a) {
  const glm::dvec3 b_centre = centre_of(b), a_centre = centre_of(a);
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < a.size(); ++i) moment += eigen(b[i] - b_centre) * eigen(a[i] - a_centre).transpose();
  return moment;
}

// Horn's quaternion is the eigenvector of the largest eigenvalue of a symmetric matrix made from the points' moment.
// Among all orthogonal matrices a reflection fits best if the moment's determinant is negative.
RigidFit fit_rigid(const Points& from, const Points& to) {
  const Eigen::Matrix3d m = moment_of(to, from);
  Eigen::Matrix4d horn;
  horn << m.trace(), m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1),  //
      0, m(0, 0) - m(1, 1) - m(2, 2), m(0, 1) + m(1, 0), m(2, 0) + m(0, 2),    //
      0, 0, m(1, 1) - m(0, 0) - m(2, 2), m(1, 2) + m(2, 1),                    //
      0, 0, 0, m(2, 2) - m(0, 0) - m(1, 1);
  const Eigen::Matrix4d lower = horn.transpose();  // the triangle that the solver reads
  const Eigen::Vector4d q = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(lower).eigenvectors().col(3);
  RigidFit fit;
  fit.mirrored = m.determinant() < 0;
  fit.to_from.rotation = glm::mat3_cast(glm::normalize(glm::dquat(q[0], q[1], q[2], q[3])));
  fit.to_from.translation = centre_of(to) - fit.to_from.rotation * centre_of(from);
  return fit;
}

/// RMS distances from the best-fitting line and plane.
struct Spread {
  double off_line_mm, off_plane_mm;
  bool enough() const { return off_line_mm >= kMinOffLine_mm && off_plane_mm >= kMinOffPlane_mm; }
};

Spread spread_of(const Points& points) {
  const Eigen::Matrix3d moment = moment_of(points, points) / double(points.size());
  const Eigen::Vector3d rising = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moment).eigenvalues();
  return {std::sqrt(std::max(0.0, rising[0] + rising[1])), std::sqrt(std::max(0.0, rising[0]))};
}

Points places(const std::vector<const LandmarkPair*>& pairs, glm::dvec3 LandmarkPair::*where) {
  Points points;
  for (const LandmarkPair* pair : pairs) points.push_back(pair->*where);
  return points;
}

bool finite(const Points& points) {
  return std::all_of(points.begin(), points.end(), [](const glm::dvec3& point) {
    return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
  });
}

double error_mm(const Pose& ct_from_touched, const LandmarkPair& pair) {
  return glm::distance(ct_from_touched.point(pair.touched_mm), pair.ct_mm);
}

template <typename Pairs>
double rms_error_mm(const Pose& ct_from_touched, const Pairs& pairs) {
  double squares = 0;
  for (const LandmarkPair* pair : pairs) squares += std::pow(error_mm(ct_from_touched, *pair), 2);
  return std::sqrt(squares / double(pairs.size()));
}

// Leaves out each landmark once, because a landmark in error would pull a fit that includes it towards itself.
void find_worst(std::span<const LandmarkPair> pairs, Registration& found) {
  for (std::size_t out = 0; out < pairs.size(); ++out) {
    std::vector<const LandmarkPair*> others;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (i != out) others.push_back(&pairs[i]);
    const RigidFit fit = fit_rigid(places(others, &LandmarkPair::touched_mm), places(others, &LandmarkPair::ct_mm));
    const double error = error_mm(fit.to_from, pairs[out]);
    if (error <= found.worst_mm) continue;
    found.worst_mm = error;
    found.worst = pairs[out].name;
  }
}

}  // namespace

Outcome<Registration> register_landmarks(std::span<const LandmarkPair> pairs) {
  std::vector<const LandmarkPair*> fitted, held_out;
  for (const LandmarkPair& pair : pairs) (pair.held_out ? held_out : fitted).push_back(&pair);
  char text[240];
  if (fitted.size() < kMinLandmarks || held_out.empty()) {
    std::snprintf(text, sizeof text,
                  "There are %zu landmarks to fit and %zu to check; touch %zu or more, and one more that is held out.",
                  fitted.size(), held_out.size(), kMinLandmarks);
    return Refusal{text};
  }
  const Points touched = places(fitted, &LandmarkPair::touched_mm), ct = places(fitted, &LandmarkPair::ct_mm);
  if (!finite(touched) || !finite(ct)) return Refusal{"A landmark's position is not a number; touch it again."};
  for (const Points& points : {touched, ct}) {
    const Spread spread = spread_of(points);
    if (spread.enough()) continue;
    const bool line = spread.off_line_mm < kMinOffLine_mm;
    std::snprintf(
        text, sizeof text,
        "The landmarks lie within %.0f mm of a %s, RMS; take some from the front, both sides, top and bottom.",
        line ? spread.off_line_mm : spread.off_plane_mm, line ? "line" : "plane");
    return Refusal{text};
  }
  const RigidFit fit = fit_rigid(touched, ct);
  Registration found;
  found.ct_from_touched = fit.to_from;
  found.residual_mm = rms_error_mm(fit.to_from, fitted);
  found.accuracy_mm = rms_error_mm(fit.to_from, held_out);
  find_worst(pairs, found);
  if (fit.mirrored)
    return Refusal{
        "The landmarks fit the mirrored patient; see whether left and right were exchanged, and whether the "
        "axes were checked."};
  if (found.residual_mm > kMaxLandmarkResidual_mm) {
    std::snprintf(
        text, sizeof text,
        "The landmarks miss the CT's by %.0f mm, and %s by %.0f; see whether they were touched in the order that "
        "is asked for.",
        found.residual_mm, found.worst.c_str(), found.worst_mm);
    return Refusal{text};
  }
  return found;
}

}  // namespace insonate
