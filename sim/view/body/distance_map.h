#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace insonate::view {

/// The greatest distance of a map. Longer leaps would hardly save a ray any step.
inline constexpr int kMaxDistance = 31;

/// Returns for each cell of a box how many cells away the nearest busy one is: the largest of the steps along x, y and
/// z (Chebyshev), at most kMaxDistance; 0 for a busy one. All cells nearer than that are empty, so that a ray can leap
/// over them (Deakin, Knackstedt 2019, "Accelerated Volume Rendering with Chebyshev Distance Maps").
/// @param size  cells along each axis, x fastest
/// @param busy  per cell: 0 if it is empty
std::vector<std::uint8_t> distance_map(const glm::ivec3& size, const std::vector<std::uint8_t>& busy);

}  // namespace insonate::view
