#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace insonate {

/// Names by label value, 1 to 255.
using LabelNames = std::map<int, std::string>;

/// Returns a label table of TotalSegmentator's task `total`, for files without their own: "total" for version 2,
/// "total_v1" for version 1. Returns nothing for another name.
std::optional<LabelNames> standard_label_table(std::string_view name);
/// Returns the names that standard_label_table() knows.
std::vector<std::string> standard_label_tables();

/// Returns the tissue (a [tissue.*] of assets/tissues.toml) of a structure, by TotalSegmentator's lower-case name for
/// it. Returns nothing for an unknown structure.
std::optional<std::string> tissue_of_structure(std::string_view structure);

/// Returns the tissue of a finding in or beside an organ (a cyst, a stone, fluid, a haematoma), by a part of its name,
/// whatever the organ. tissue_of_structure() checks this first. Returns nothing for any other name.
std::optional<std::string> finding_tissue(std::string_view structure);

/// Returns a structure's name for display: "kidney_right" becomes "Right kidney".
std::string title_of_structure(std::string_view structure);

}  // namespace insonate
