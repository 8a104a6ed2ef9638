#pragma once

#include "sim/tissue/acoustic_volume.h"

namespace insonate {

/// Returns a volume with fewer voxels, for images whose pixels are far larger than the volume's: the mean density of
/// blocks of voxels, without echogenicity. A block is as many voxels long as fit `spacing_mm`, at least one. The last
/// block of an axis may lack some of its voxels: it has the mean of the others, at the place of a whole block.
/// @param spacing_mm  above 0
AcousticVolume coarse_volume(const AcousticVolume& volume, double spacing_mm);

}  // namespace insonate
