#pragma once

#include <glm/vec3.hpp>

#include <cstdint>

#include "sim/core/grid.h"

namespace insonate {

// Filters of masks: voxels of 0 and 1.

/// Erosion (or dilation): each voxel becomes the minimum (or maximum) within `radius` voxels along each axis. Values
/// beyond the border equal those on it, so that a body cut by the CT is not eroded there.
void filter_box(Volume<std::uint8_t>& mask, const glm::ivec3& radius, bool grow);

/// Keeps the largest piece of face-connected voxels. Among equal ones, keeps the first in memory.
void keep_largest_piece(Volume<std::uint8_t>& mask);

}  // namespace insonate
