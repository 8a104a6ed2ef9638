#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace insonate {

/// What a NIfTI file (.nii, .nii.gz) carries between its header and its voxels, an entry's bytes each without its size
/// and code; ITK does not hand them out. Empty for a file that has none or is no NIfTI file. Throws InputError when an
/// entry's size cannot be, or when they take more than 16 MiB.
std::vector<std::string> read_nifti_extensions(const std::filesystem::path& file);

}  // namespace insonate
