#include "sim/registration/tracked_sweep.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace insonate {
namespace {

constexpr int kPointsAlong = 5;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

}  // namespace

std::vector<glm::dvec3> target_points(const TrackedSweep& sweep) {
  Probe probe = sweep.probe;
  probe.lines = kPointsAlong;
  const ScanLines lines = scan_lines(probe, sweep.depth_mm, kPointsAlong);
  std::vector<glm::dvec3> points;
  for (const SweepImage& image : sweep.images)
    for (const ScanLine& line : lines.lines)
      for (int k = 0; k < lines.samples; ++k)
        points.push_back(image.sweep_from_probe.point(line.start + (k + 0.5) * lines.dr_mm() * line.direction));
  return points;
}

double spread_mm(const TrackedSweep& sweep) {
  const glm::dmat4 fan = moments_of(target_points({Probe(sweep.probe), sweep.depth_mm, std::vector<SweepImage>(1)}));
  double most = 0;
  for (const SweepImage& a : sweep.images)
    for (const SweepImage& b : sweep.images)
      most = std::max(most, target_error_mm(fan, a.sweep_from_probe.matrix(), b.sweep_from_probe.matrix()));
  return most;
}

double target_error_mm(const std::vector<glm::dvec3>& points, const glm::dmat4& one, const glm::dmat4& other) {
  return target_error_mm(moments_of(points), one, other);
}

glm::dmat4 moments_of(const std::vector<glm::dvec3>& points) {
  glm::dmat4 sum(0.0);
  for (const glm::dvec3& point : points) sum += glm::outerProduct(glm::dvec4(point, 1), glm::dvec4(point, 1));
  return points.empty() ? sum : sum / double(points.size());
}

double target_error_mm(const glm::dmat4& moments, const glm::dmat4& one, const glm::dmat4& other) {
  const glm::dmat4 apart = one - other, products = apart * moments;
  double mean = 0;  // the trace of apart * moments * apart^T
  for (int i = 0; i < 4; ++i) mean += glm::dot(products[i], apart[i]);
  return std::sqrt(std::max(mean, 0.0));
}

Image<float> resampled(const Image<float>& image, const glm::dmat3& pixel_from_plane, const ImageGeometry& geometry) {
  Image<float> result(geometry.width, geometry.height, kUnknown);
  const glm::dvec2 step(glm::length(glm::dvec2(pixel_from_plane[0])) * geometry.mm_per_pixel,
                        glm::length(glm::dvec2(pixel_from_plane[1])) * geometry.mm_per_pixel);
  const glm::dvec2 sigma = glm::max(step, glm::dvec2(1)) / 2.0;
  const int reach_x = int(std::ceil(2 * sigma.x)), reach_y = int(std::ceil(2 * sigma.y));
  tbb::parallel_for(0, geometry.height, [&](int y) {
    for (int x = 0; x < geometry.width; ++x) {
      const glm::dvec3 at = pixel_from_plane * glm::dvec3(geometry.plane_mm(x, y), 1);
      const int column = int(std::lround(at.x)), row = int(std::lround(at.y));
      double sum = 0, known = 0, all = 0;
      for (int j = row - reach_y; j <= row + reach_y; ++j)
        for (int i = column - reach_x; i <= column + reach_x; ++i) {
          const glm::dvec2 apart = (glm::dvec2(i, j) - glm::dvec2(at)) / sigma;
          const double weight = std::exp(-0.5 * glm::dot(apart, apart));
          all += weight;
          if (i < 0 || j < 0 || i >= image.width || j >= image.height || std::isnan(image.at(i, j))) continue;
          known += weight;
          sum += weight * image.at(i, j);
        }
      if (known > 0.5 * all) result.at(x, y) = float(sum / known);
    }
  });
  return result;
}

double variation_in_depth(const Image<float>& grey) {
  double count = 0, sum = 0, squares = 0;
  for (int y = grey.height / 5; y < grey.height * 3 / 5; ++y)
    for (int x = 0; x < grey.width; ++x) {
      const double value = grey.at(x, y);
      if (std::isnan(value)) continue;
      ++count;
      sum += value;
      squares += value * value;
    }
  return count > 0 ? squares - sum * sum / count : 0;
}

TrackedSweep reduced(const TrackedSweep& sweep, int count, int width, int height) {
  TrackedSweep result{Probe(sweep.probe), sweep.depth_mm, {}};
  const ImageGeometry to = image_geometry(sweep.probe, sweep.depth_mm, width, height);
  const std::size_t kept = std::min(sweep.images.size(), std::size_t(count));
  for (std::size_t i = 0; i < kept; ++i) {
    const SweepImage& image = sweep.images[(2 * i + 1) * sweep.images.size() / (2 * kept)];
    const ImageGeometry from = image_geometry(sweep.probe, sweep.depth_mm, image.grey.width, image.grey.height);
    if (image.grey.width == width && image.grey.height == height) {
      result.images.push_back(image);
      continue;
    }
    glm::dmat3 pixel_from_plane(1 / from.mm_per_pixel);
    pixel_from_plane[2] = glm::dvec3(-from.top_left_mm / from.mm_per_pixel, 1);
    result.images.push_back({image.sweep_from_probe, resampled(image.grey, pixel_from_plane, to)});
  }
  return result;
}

}  // namespace insonate
