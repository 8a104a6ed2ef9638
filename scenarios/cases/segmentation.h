#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/phantom/phantom.h"
#include "sim/volume/case.h"

namespace insonate {

/// The structures of one patient, on the grid of a CT.
struct Segmentation {
  Volume<std::uint8_t> labels;
  std::vector<Label> table;        ///< structures that have voxels, by rising value
  std::vector<std::string> notes;  ///< one sentence for each omission, change or guess
};

/// Reads TotalSegmentator's output: one file with many labels, or a folder with one mask per structure. A mask is named
/// after its structure (liver.nii.gz) and consists of all voxels that are not 0. Labels on another grid than the CT's
/// are resampled to smooth surfaces (resample_labels()). Names become lower case with underscores. An unknown structure
/// is treated as soft tissue.
///
/// The names of a file's labels come from its header. If `label_table` names a standard table
/// (standard_label_tables()), that table replaces them. Where masks overlap, the smaller structure gets the voxel.
/// Throws InputError if nothing can be read or nothing lies within the CT, for values without a name, for names that
/// become identical, for more than 255 structures, and for a mask with several values.
Segmentation read_segmentation(const std::filesystem::path& file_or_folder, const Grid& ct,
                               const std::string& label_table = "", const Progress& progress = {});

}  // namespace insonate
