#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace insonate {

class Points;

/// Smooth noise in space: zero mean, standard deviation about 1, wavelengths from one to a few times the grain and
/// nothing finer, no visible lattice. A pure function of seed and position, so that any thread may ask in any order.
///
/// Two layers of gradient noise (Perlin, "An image synthesizer", 1985; the smooth step of his "Improving noise", 2002),
/// the second finer and turned against the first.
class Texture {
public:
  Texture(std::uint32_t seed, float grain_mm) : seed_(seed), per_mm_(1.0f / grain_mm) {}

  float at(const glm::vec3& position_mm) const;

  /// The same at those of the points that `which` names, in that order, several times as fast.
  std::vector<float> at(const Points& points, const std::vector<std::size_t>& which) const;

private:
  std::uint32_t seed_;
  float per_mm_;
};

}  // namespace insonate
