#pragma once

#include <glm/vec3.hpp>

#include "sim/gl/objects.h"
#include "sim/tissue/acoustic_volume.h"

namespace insonate::gl {

/// Returns the differences of HU along the CT's axes i, j, k at a voxel, over the reflection length around its centre,
/// linear between voxels. Beyond the CT is air.
/// @param reflection_length_mm  0.01 to 20
glm::dvec3 density_change(const AcousticVolume& volume, const glm::ivec3& voxel, double reflection_length_mm);

/// Returns a CT with its gradient: (HU, its differences along the CT's axes i, j, k in eighths of HU) / 32767, with
/// kAirMargin of air without a gradient around it. Differences above 4095 HU are clamped to that. A voxel takes 8
/// bytes, or 16 with a software renderer if it can hold them, because it fetches those faster. Throws TextureRefused.
/// @param reflection_length_mm  differences are taken over this length, 0.01 to 20
Texture density_volume(const AcousticVolume& volume, double reflection_length_mm);

}  // namespace insonate::gl
