#pragma once

#include <filesystem>

#include "sim/tissue/tissue.h"
#include "sim/volume/case.h"

namespace insonate {

/// Adds a plane that an expert has scanned to a case folder, as a reference view. The checks precede any writing: the
/// name is new; probe, targets and landmarks exist; the face is on the skin; each target and each landmark is in the
/// picture as ViewMeter measures it. So a learner who holds the probe exactly at this pose gets full points. The file
/// is replaced as a whole and retains all other content that a person has written into it. Throws InputError if a check
/// fails or the file cannot be read or written.
void add_view(const std::filesystem::path& case_folder, const ReferenceView& view, const TissueTable& tissues);

}  // namespace insonate
