#include "sim/gl/fan_layout.h"

#include <algorithm>

namespace insonate::gl {
namespace {

// The part of a window around `at` that lies in a row or column of `length` values, `stride` apart.
double window_sum(const double* values, int at, int length, std::ptrdiff_t stride, const std::vector<double>& window) {
  const int radius = int(window.size() / 2);
  double sum = 0;
  for (int j = std::max(-radius, -at); j <= std::min(radius, length - 1 - at); ++j)
    sum += window[std::size_t(j + radius)] * values[(at + j) * stride];
  return sum;
}

}  // namespace

FanLayout::FanLayout(const Probe& probe, double depth_mm, const ScanLines& lines, int width, int height)
    : geometry(image_geometry(probe, depth_mm, width, height)), inside(width, height) {
  line_and_sample.assign(inside.pixels.size(), glm::vec2(-2));
  std::size_t pixel = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, ++pixel)
      if (const auto at = line_position(probe, depth_mm, geometry.plane_mm(x, y))) {
        inside.pixels[pixel] = 1;
        line_and_sample[pixel] = glm::vec2(at->line, at->r_mm / lines.dr_mm() - 0.5);
      }

  const auto touched = [&](const glm::ivec2& low) {
    for (int y = low.y; y < std::min(low.y + kBlock.y, height); ++y)
      for (int x = low.x; x < std::min(low.x + kBlock.x, width); ++x)
        if (inside.at(x, y)) return true;
    return false;
  };
  for (int y = 0; y * kBlock.y < height; ++y)
    for (int x = 0; x * kBlock.x < width; ++x)
      if (touched(glm::ivec2(x, y) * kBlock)) blocks.emplace_back(x, y);
}

Image<float> one_over_window_inside(const Image<std::uint8_t>& inside, const std::vector<double>& window) {
  const int width = inside.width, height = inside.height;
  const std::vector<double> mask(inside.pixels.begin(), inside.pixels.end());
  std::vector<double> rows(mask.size());
  Image<float> result(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t row = std::size_t(y) * std::size_t(width), i = row + std::size_t(x);
      rows[i] = mask[i] * window_sum(mask.data() + row, x, width, 1, window);
    }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (inside.at(x, y)) result.at(x, y) = float(1 / window_sum(rows.data() + x, y, height, width, window));
  return result;
}

}  // namespace insonate::gl
