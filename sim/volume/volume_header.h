#pragma once

#include <filesystem>
#include <string>

#include "sim/core/grid.h"
#include "sim/volume/voxel_data.h"

namespace insonate {

/// What the header of a volume file states.
struct VolumeHeader {
  std::string format;  ///< "NIfTI", "NRRD", "MetaImage"
  Grid grid;           ///< in LPS, at most 4096 voxels per side and 2^31 in all; for checked_grid() to check the rest
  VoxelData data;
};

/// Reads the header of a NIfTI (.nii, .nii.gz), NRRD (.nrrd, .nhdr) or MetaImage (.mha, .mhd) file, chosen by the
/// file name's ending. Throws InputError for a header that is damaged, claims more or fewer bytes than the file holds,
/// or describes anything but a 3D volume with one number per voxel and lengths in mm.
VolumeHeader read_volume_header(const std::filesystem::path& file);

}  // namespace insonate
