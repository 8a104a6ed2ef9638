#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/phantom/phantom.h"
#include "sim/tissue/tissue.h"
#include "sim/volume/case.h"

namespace insonate {

/// The user's input for an import: a patient's CT and its segmentation.
struct ImportRequest {
  std::filesystem::path ct;      ///< any input of read_ct()
  std::filesystem::path labels;  ///< any input of read_segmentation()
  std::string label_table;       ///< for labels without names; see read_segmentation()
  std::string name;              ///< name of the case; "Patient" if empty, because a file's name may be a person's
};

/// The result of an import.
struct ImportedCase {
  Case subject;
  std::vector<std::string> notes;  ///< one sentence for each guess, change or omission
};

/// Makes a case from a CT and its segmentation by TotalSegmentator. Resamples a coarser CT to voxels of
/// kInsonatedVoxel_mm and removes table and clothes. Labels are resampled to smooth surfaces (resample_labels()). The
/// sinus of each kidney gets a label (kidney_sinus.h).
///
/// Each compact organ (liver, spleen, kidneys, gallbladder, pancreas, bladder, prostate) has landmarks at its centre,
/// "liver_centre", and at the ends of its long axis, "kidney_right_upper_pole". The abdominal aorta and vena cava have
/// landmarks at their centres at the heights of whole vertebrae, "aorta_l2", or else at a quarter, half and three
/// quarters of their length, "aorta_lower". "hepatorenal_recess" and "splenorenal_recess" lie where the two organs come
/// closest. The views are those of suggest_views(). Throws InputError if the input cannot be read or is implausible.
ImportedCase import_case(const ImportRequest& request, const TissueTable& tissues, const Progress& progress = {});

}  // namespace insonate
