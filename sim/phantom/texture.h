#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace insonate {

class Points;

/// Smooth noise in space, smooth_noise() of a seed, with wavelengths of one to a few times the grain.
class Texture {
public:
  Texture(std::uint32_t seed, float grain_mm) : seed_(seed), per_mm_(1.0f / grain_mm) {}

  float at(const glm::vec3& position_mm) const;

  /// Returns the noise at the points with the indices `which`, in that order, several times as fast.
  std::vector<float> at(const Points& points, const std::vector<std::size_t>& which) const;

  /// Returns the noise at positions given as one coordinate per position in each vector, mm.
  std::vector<float> at(std::vector<float> x_mm, std::vector<float> y_mm, std::vector<float> z_mm) const;

private:
  std::uint32_t seed_;
  float per_mm_;
};

}  // namespace insonate
