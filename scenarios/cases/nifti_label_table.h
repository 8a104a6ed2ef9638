#pragma once

#include <filesystem>

#include "scenarios/cases/structures.h"

namespace insonate {

/// The label table that a NIfTI file carries in an extension of its header, as TotalSegmentator writes it: Caret's XML,
/// CaretExtension / VolumeInformation / LabelTable / Label with the value as the attribute Key and the name as text.
/// The value 0 is the background and left out. Empty when the file has no such table or is no NIfTI file. Throws
/// InputError when it is damaged, names a value twice or not at all, or goes beyond 255.
LabelNames read_nifti_label_table(const std::filesystem::path& file);

}  // namespace insonate
