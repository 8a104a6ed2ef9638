#pragma once

#include <string>
#include <vector>

#include "sim/volume/case.h"

namespace insonate {

/// Labels the sinus of each kidney, "kidney_right_sinus" of the tissue kidney_sinus. TotalSegmentator labels the
/// parenchyma alone: the fat, vessels and collecting system that it encloses have no label, and would look like the fat
/// around the kidney. In ultrasound they are a kidney's bright middle.
///
/// The sinus is what has no label and is denser than gas within the kidney's closing by a cube of twice 12 mm, without
/// layers of less than three voxels, in one piece. Under 1 ml is none. A kidney whose sinus has a label already is left
/// alone, and so are all once the 255 values of labels are used up. Returns a note on each.
std::vector<std::string> label_kidney_sinuses(Case& subject);

}  // namespace insonate
