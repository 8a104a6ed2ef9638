#pragma once

#include <cstddef>
#include <cstdint>

namespace insonate {

/// Writes smooth noise in space to out[0 .. count), at positions given in units of the grain. The noise has zero mean
/// and a standard deviation of about 1. Its wavelengths are one to a few grains and nothing finer. It does not repeat,
/// and no lattice is visible. It is a pure function of seed and position, so that threads can evaluate it in any order.
///
/// It sums two layers of gradient noise (Perlin, "An image synthesizer", 1985; the smooth step of his "Improving
/// noise", 2002). The second layer is finer and rotated against the first.
/// @param x, y, z  `count` coordinates each, below 2^30 in size
void smooth_noise(std::uint32_t seed, const float* x, const float* y, const float* z, std::size_t count, float* out);

}  // namespace insonate
