#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/volume/volume_header.h"

namespace insonate {

/// Reads the header of a NIfTI-1 or NIfTI-2 file, plain or packed by gzip. The volume is placed by the sform if the
/// file has no qform or calls the sform the scanner's frame (code 1), and if its axes are at right angles and have the
/// lengths in pixdim; otherwise by the qform. A file with neither begins at zero with the axes of LPS. ITK and
/// 3D Slicer choose in the same way. Throws InputError as read_volume_header() does.
VolumeHeader read_nifti_volume_header(const std::filesystem::path& file);

/// Returns the header extensions of a NIfTI file: the bytes of each entry between header and voxels, without its size
/// and code. Returns nothing for a file that has none or is not NIfTI. Throws InputError if an entry's size is
/// impossible, or if the entries take more than 16 MiB.
std::vector<std::string> read_nifti_extensions(const std::filesystem::path& file);

}  // namespace insonate
