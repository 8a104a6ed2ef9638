#pragma once

#include "sim/gl/objects.h"
#include "sim/model/acoustic_volume.h"

namespace insonate::gl {

/// A CT with its gradient: (HU, its differences along the CT's axes i, j, k in eighths of HU) / 32767, with kAirMargin
/// of air without a gradient around it. Differences above 4095 HU count as that. Eight bytes a voxel, or sixteen where
/// a software renderer holds them, which fetches those faster. Throws TextureRefused.
/// @param reflection_length_mm  0.01 to 20
Texture density_volume(const AcousticVolume& volume, double reflection_length_mm);

}  // namespace insonate::gl
