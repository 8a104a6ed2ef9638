#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace insonate {

class Points;

/// Smooth noise in space with zero mean and a standard deviation of about 1. Its wavelengths are one to a few times the
/// grain and nothing finer; no lattice is visible. It is a pure function of seed and position, so any thread can
/// evaluate it in any order.
///
/// It sums two layers of gradient noise (Perlin, "An image synthesizer", 1985; the smooth step of his "Improving
/// noise", 2002). The second layer is finer and rotated against the first.
class Texture {
public:
  Texture(std::uint32_t seed, float grain_mm) : seed_(seed), per_mm_(1.0f / grain_mm) {}

  float at(const glm::vec3& position_mm) const;

  /// Returns the noise at the points with the indices `which`, in that order, several times as fast.
  std::vector<float> at(const Points& points, const std::vector<std::size_t>& which) const;

  /// Returns the noise at positions given as one coordinate per position in each vector, mm.
  std::vector<float> at(const std::vector<float>& x_mm, const std::vector<float>& y_mm,
                        const std::vector<float>& z_mm) const;

private:
  std::uint32_t seed_;
  float per_mm_;
};

}  // namespace insonate
