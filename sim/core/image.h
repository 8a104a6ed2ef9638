#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace insonate {

/// Holds one value per pixel, rows from top to bottom, x fastest.
template <typename T>
struct Image {
  int width = 0;
  int height = 0;
  std::vector<T> pixels;

  Image() = default;
  Image(int w, int h, const T& fill = T{}) : width(w), height(h), pixels(std::size_t(w) * std::size_t(h), fill) {}
  T& at(int x, int y) { return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
  const T& at(int x, int y) const { return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
};

/// Samples an image between its pixels, linearly along both axes. Positions beyond the outer pixels' middles take their
/// values. @param x, y  in pixels; whole numbers are the middles
inline double bilinear(const Image<double>& image, double x, double y) {
  x = std::clamp(x, 0.0, image.width - 1.0);
  y = std::clamp(y, 0.0, image.height - 1.0);
  const int x0 = int(x), x1 = std::min(x0 + 1, image.width - 1);
  const int y0 = int(y), y1 = std::min(y0 + 1, image.height - 1);
  const double fx = x - x0, fy = y - y0;
  return (1 - fy) * ((1 - fx) * image.at(x0, y0) + fx * image.at(x1, y0)) +
         fy * ((1 - fx) * image.at(x0, y1) + fx * image.at(x1, y1));
}

/// Returns the image with left and right exchanged. Screens and PNG files show ultrasound this way: the pipeline's
/// pictures have the probe's marker (+x) on the right, clinics have it on the left.
template <typename T>
Image<T> mirrored(const Image<T>& image) {
  Image<T> out = image;
  for (int y = 0; y < out.height; ++y) {
    const auto row = out.pixels.begin() + std::ptrdiff_t(y) * out.width;
    std::reverse(row, row + out.width);
  }
  return out;
}

/// Returns the image with top and bottom exchanged, as OpenGL's framebuffers are read.
template <typename T>
Image<T> upright(const Image<T>& upside_down) {
  Image<T> out(upside_down.width, upside_down.height);
  for (int y = 0; y < out.height; ++y) {
    const auto from = upside_down.pixels.begin() + std::ptrdiff_t(out.height - 1 - y) * out.width;
    std::copy(from, from + out.width, out.pixels.begin() + std::ptrdiff_t(y) * out.width);
  }
  return out;
}

using Rgba8 = std::array<std::uint8_t, 4>;

}  // namespace insonate
