#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/model/tissue.h"
#include "sim/phantom/phantom.h"
#include "sim/volume/case.h"

namespace insonate {

/// A patient's CT and its segmentation, as a person names them.
struct ImportRequest {
  std::filesystem::path ct;      ///< whatever read_ct() reads
  std::filesystem::path labels;  ///< whatever read_segmentation() reads
  std::string label_table;       ///< for labels without names: see read_segmentation()
  std::string name;              ///< of the case; "Patient" when empty: a file's name may be a person's
};

struct ImportedCase {
  Case subject;
  std::vector<std::string> notes;  ///< a sentence each: what was guessed, changed or left out
};

/// Makes a case of a CT and what TotalSegmentator found in it. The CT is brought to voxels of kInsonatedVoxelMm where
/// it is coarser, and cleared of table and clothes; labels come along by nearest neighbour.
///
/// Landmarks of each compact organ (liver, spleen, kidneys, gallbladder, pancreas, bladder, prostate) are its centre,
/// "liver_centre", and the ends of its long axis, "kidney_right_upper_pole"; of the aorta and the vena cava in the
/// abdomen their centres at the heights of whole vertebrae, "aorta_l2", or at a quarter, half and three quarters of
/// their length, "aorta_lower"; "hepatorenal_recess" and "splenorenal_recess" lie where the two organs come closest.
/// Views are those of suggest_views(). Throws InputError.
ImportedCase import_case(const ImportRequest& request, const TissueTable& tissues, const Progress& progress = {});

}  // namespace insonate
