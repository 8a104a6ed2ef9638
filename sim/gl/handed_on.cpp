#include "sim/gl/handed_on.h"

#include <glm/gtc/packing.hpp>

#include <cstdint>
#include <vector>

namespace insonate::gl {
namespace {

/// Which of the four are kept as fourth roots where they are half floats.
using Rooted = std::array<bool, 4>;

std::array<Image<float>, 4> read_fours(const TexelBuffer& buffer, bool half_floats, const Rooted& rooted, int width,
                                       int height) {
  const Image<float> image(width, height);
  std::array<Image<float>, 4> images{image, image, image, image};
  const std::size_t count = 4 * image.pixels.size();
  std::vector<float> values(count);
  if (half_floats) {
    std::vector<std::uint16_t> kept(count);
    buffer.read(kept.data(), count * sizeof kept.front());
    for (std::size_t i = 0; i < count; ++i) {
      const float value = glm::unpackHalf1x16(kept[i]), squared = value * value;
      values[i] = rooted[i % 4] ? squared * squared : value;
    }
  } else {
    buffer.read(values.data(), count * sizeof values.front());
  }
  for (std::size_t i = 0; i < count; ++i) images[i % 4].pixels[i / 4] = values[i];
  return images;
}

}  // namespace

std::pair<std::string, std::string> handed_on_define(bool half_floats) {
  return {"HALF_FLOATS", half_floats ? "1" : "0"};
}

TexelBuffer handed_on_pairs(bool half_floats, std::size_t count) {
  return TexelBuffer(half_floats ? GL_RG16F : GL_RG32F, count);
}
TexelBuffer handed_on_fours(bool half_floats, std::size_t count) {
  return TexelBuffer(half_floats ? GL_RGBA16F : GL_RGBA32F, count);
}

std::array<Image<float>, 4> read_scan(const TexelBuffer& scan, bool half_floats, int width, int height) {
  return read_fours(scan, half_floats, {true, true, false, false}, width, height);
}
std::array<Image<float>, 4> read_echoes(const TexelBuffer& echoes, bool half_floats, int width, int height) {
  return read_fours(echoes, half_floats, {true, true, false, true}, width, height);
}

}  // namespace insonate::gl
