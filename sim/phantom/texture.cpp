#include "sim/phantom/texture.h"

#include <array>

#include "sim/core/hash.h"

namespace insonate {
namespace {

// Slope at a lattice point along one of the cube's twelve edge directions, times the way from the lattice point.
float slope(std::uint32_t bits, float x, float y, float z) {
  const bool skip_x = bits % 3 == 0, skip_y = bits % 3 == 1;
  const float u = skip_x ? y : x;
  const float v = skip_x || skip_y ? z : y;
  return ((bits & 0x100u) != 0 ? u : -u) + ((bits & 0x200u) != 0 ? v : -v);
}

float fade(float t) {
  return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

// The whole number at or below, for numbers that an int holds; faster than the library's floor.
float below(float value) {
  const auto whole = float(int(value));
  return whole > value ? whole - 1.0f : whole;
}

float gradient_noise(std::uint32_t seed, const glm::vec3& p) {
  const float fx = below(p.x), fy = below(p.y), fz = below(p.z);
  const float x = p.x - fx, y = p.y - fy, z = p.z - fz;
  const float u = fade(x), v = fade(y), w = fade(z);
  const auto i = std::uint32_t(int(fx)), j = std::uint32_t(int(fy)), k = std::uint32_t(int(fz));

  std::array<float, 4> edges;
  for (std::uint32_t n = 0; n < 4; ++n) {
    const std::uint32_t dj = n & 1u, dk = n >> 1u;
    const std::uint32_t column = hash(hash(seed, k + dk), j + dj);
    const float low = slope(hash(column, i), x, y - float(dj), z - float(dk));
    const float high = slope(hash(column, i + 1), x - 1.0f, y - float(dj), z - float(dk));
    edges[n] = low + u * (high - low);
  }
  const float front = edges[0] + v * (edges[1] - edges[0]);
  const float back = edges[2] + v * (edges[3] - edges[2]);
  return front + w * (back - front);
}

// Standard deviation of the two layers' sum, measured over 10^6 points.
constexpr float kStandardDeviation = 0.33f;

}  // namespace

float Texture::at(const glm::vec3& position_mm) const {
  const glm::vec3 p = position_mm * per_mm_;
  // A turn by the quaternion (0.5, 0.5, 0.3, 0.64), normalised, and a scale of 1.7 that no lattice step repeats.
  const glm::vec3 turned =
      1.7f * glm::vec3(0.3337f * p.x - 0.1363f * p.y + 0.9328f * p.z, 0.9387f * p.x + 0.1486f * p.y - 0.3141f * p.z,
                       -0.0958f * p.x + 0.9795f * p.y + 0.1774f * p.z);
  return (gradient_noise(seed_, p) + 0.6f * gradient_noise(hash(seed_), turned)) / kStandardDeviation;
}

}  // namespace insonate
