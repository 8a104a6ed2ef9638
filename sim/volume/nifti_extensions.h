#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace insonate {

/// Returns the header extensions of a NIfTI file (.nii, .nii.gz), which ITK does not expose: the bytes of each entry
/// between header and voxels, without its size and code. Returns nothing for a file that has none or is not NIfTI.
/// Throws InputError if an entry's size is impossible, or if the entries take more than 16 MiB.
std::vector<std::string> read_nifti_extensions(const std::filesystem::path& file);

}  // namespace insonate
