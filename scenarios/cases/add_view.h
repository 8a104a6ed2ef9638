#pragma once

#include <filesystem>

#include "sim/model/tissue.h"
#include "sim/volume/case.h"

namespace insonate {

/// Adds a plane that an expert has held to a case folder, as a reference view. Checked before anything is written: the
/// name is new; probe, targets and landmarks are there; the face is on the skin; each target and each landmark is in
/// the picture, as ViewMeter sees it, so that whoever holds the probe just so gets full points. The file is replaced as
/// a whole, and keeps what else a person has written into it. Throws InputError.
void add_view(const std::filesystem::path& case_folder, const ReferenceView& view, const TissueTable& tissues);

}  // namespace insonate
