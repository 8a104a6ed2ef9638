#pragma once

#include "sim/tissue/acoustic_volume.h"

namespace insonate {

/// Returns a volume with fewer voxels, for images whose pixels are far larger than its own: the mean density of whole
/// blocks of voxels, which have no echogenicity. A block is as many voxels long as fit `spacing_mm`, at least one. The
/// last block of an axis may lack some of its voxels; its mean is that of the others.
/// @param spacing_mm  above 0
AcousticVolume coarse_volume(const AcousticVolume& volume, double spacing_mm);

}  // namespace insonate
