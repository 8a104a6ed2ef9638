#include "sim/registration/uncertainty.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>

namespace insonate {
namespace {

constexpr int kBlock = 8;  // pixels along a side

// Returns an image without the means of its blocks.
Image<float> without_means(const Image<float>& image) {
  Image<float> rest = image;
  for (int top = 0; top < image.height; top += kBlock)
    for (int left = 0; left < image.width; left += kBlock) {
      const int bottom = std::min(top + kBlock, image.height), right = std::min(left + kBlock, image.width);
      double sum = 0, count = 0;
      for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x)
          if (!std::isnan(image.at(x, y))) {
            sum += image.at(x, y);
            ++count;
          }
      for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x) rest.at(x, y) -= float(sum / std::max(count, 1.0));
    }
  return rest;
}

}  // namespace

double independent_pixels(const TrackedSweep& sweep) {
  double known = 0, squares = 0, along_rows = 0, along_columns = 0;
  for (const SweepImage& image : sweep.images) {
    const Image<float> rest = without_means(image.grey);
    for (int y = 0; y + 1 < rest.height; ++y)
      for (int x = 0; x + 1 < rest.width; ++x) {
        const float here = rest.at(x, y), right = rest.at(x + 1, y), below = rest.at(x, y + 1);
        if (std::isnan(here) || std::isnan(right) || std::isnan(below)) continue;
        ++known;
        squares += here * here;
        along_rows += here * right;
        along_columns += here * below;
      }
  }
  if (squares == 0) return known;
  const auto share = [&](double products) {
    const double r = std::clamp(products / squares, 0.0, 0.99);
    return (1 - r) / (1 + r);
  };
  return known * share(along_rows) * share(along_columns);
}

Uncertainty uncertainty_at(const Parameters& at, const Motion& motion, const EvaluateAll& evaluate,
                           double independent_pixels, const std::vector<glm::dvec3>& targets) {
  const std::size_t n = at.size();
  const double h = kCurvatureStep_mm;
  std::vector<Parameters> points{at};
  // Both sides along a direction.
  const auto add_sides = [&](std::size_t i, std::size_t j, double towards_j) {
    for (const double step : {h, -h}) {
      Parameters point = at;
      point[i] += step;
      if (j != i) point[j] += towards_j * step;
      points.push_back(std::move(point));
    }
  };
  for (std::size_t i = 0; i < n; ++i) {
    add_sides(i, i, 0);
    for (std::size_t j = i + 1; j < n; ++j) {
      add_sides(i, j, 1);
      add_sides(i, j, -1);
    }
  }
  const std::vector<double> values = evaluate(points);
  std::size_t next = 1;
  const auto sum_of_sides = [&] {
    next += 2;
    return values[next - 2] + values[next - 1];
  };
  // A mixed derivative from both diagonals: from one and the two axes, it would have ten times the variance.
  Eigen::MatrixXd information(n, n);
  const double scale = -independent_pixels / (2 * std::max(1 - values.front(), 1e-6) * h * h);
  for (Eigen::Index i = 0; i < Eigen::Index(n); ++i) {
    information(i, i) = scale * (sum_of_sides() - 2 * values.front());
    for (Eigen::Index j = i + 1; j < Eigen::Index(n); ++j) {
      const double along = sum_of_sides(), across = sum_of_sides();
      information(i, j) = information(j, i) = scale * (along - across) / 4;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(information);
  Uncertainty result;
  result.is_maximum = solver.info() == Eigen::Success && solver.eigenvalues().minCoeff() > 0;
  if (!result.is_maximum) return result;
  const Eigen::MatrixXd covariance =
      solver.eigenvectors() * solver.eigenvalues().cwiseInverse().asDiagonal() * solver.eigenvectors().transpose();
  for (Eigen::Index i = 0; i < Eigen::Index(n); ++i) result.deviation.push_back(std::sqrt(covariance(i, i)));

  // How far each parameter moves the points: differences over a length at which the motion is linear.
  constexpr double kSmall_mm = 1e-3;
  double squares = 0;
  const glm::dmat4 here = motion.at(at);
  std::vector<glm::dmat4> changes;
  for (std::size_t i = 0; i < n; ++i) {
    Parameters point = at;
    point[i] += kSmall_mm;
    changes.push_back((motion.at(point) - here) / kSmall_mm);
  }
  for (const glm::dvec3& target : targets) {
    Eigen::MatrixXd jacobian(3, n);
    for (std::size_t i = 0; i < n; ++i) {
      const glm::dvec4 change = changes[i] * glm::dvec4(target, 1);
      for (int axis = 0; axis < 3; ++axis) jacobian(axis, Eigen::Index(i)) = change[axis];
    }
    squares += (jacobian * covariance * jacobian.transpose()).trace();
  }
  result.expected_error_mm = targets.empty() ? 0 : std::sqrt(squares / double(targets.size()));
  return result;
}

}  // namespace insonate
