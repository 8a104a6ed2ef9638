#pragma once

#include <filesystem>

#include "scenarios/cases/structures.h"

namespace insonate {

/// Returns the label table in a header extension of a NIfTI file, as TotalSegmentator writes it. The format is Caret's
/// XML: CaretExtension / VolumeInformation / LabelTable / Label with the value as the attribute Key and the name as
/// text. The value 0 is the background and is left out. Returns an empty table if the file has none or is not a NIfTI
/// file. Throws InputError if the table is damaged, has a duplicate or missing value, or contains a value above 255.
LabelNames read_nifti_label_table(const std::filesystem::path& file);

}  // namespace insonate
