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
  std::vector<Label> table;        ///< those that have voxels, by rising value
  std::vector<std::string> notes;  ///< a sentence each: what was left out, changed or guessed
};

/// Reads what TotalSegmentator writes: one file of many labels, or a folder with a mask for each structure, named after
/// it (liver.nii.gz; what is not 0 belongs to it). Another grid than the CT's is resampled by nearest neighbour. Names
/// become lower case with underscores; a structure that is not known counts as soft tissue.
///
/// The names of a file's labels come from its header, or from the standard table that `label_table` names
/// (standard_label_tables()), which then counts instead. Where masks overlap, the smaller structure has the voxel.
/// Throws InputError: when nothing can be read or nothing lies within the CT, for values without a name, names that
/// become the same, more than 255 structures, and a mask of several values.
Segmentation read_segmentation(const std::filesystem::path& file_or_folder, const Grid& ct,
                               const std::string& label_table = "", const Progress& progress = {});

}  // namespace insonate
