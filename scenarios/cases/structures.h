#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace insonate {

/// Names by label value, 1 to 255.
using LabelNames = std::map<int, std::string>;

/// The label tables of TotalSegmentator's task `total`, for files that do not carry their own: "total" of version 2,
/// "total_v1" of version 1. Nothing for another name.
std::optional<LabelNames> standard_label_table(std::string_view name);
std::vector<std::string> standard_label_tables();

/// The tissue (a [tissue.*] of assets/tissues.toml) that a structure is made of, by TotalSegmentator's name for it in
/// lower case; nothing for a structure that is not known.
std::optional<std::string> tissue_of_structure(std::string_view structure);

/// The tissue of a finding in or beside an organ (a cyst, a stone, fluid, a haematoma), by a part of its name, whatever
/// the organ: tissue_of_structure() looks here first. Nothing for any other name.
std::optional<std::string> finding_tissue(std::string_view structure);

/// A structure as people write it: "kidney_right" is "Right kidney".
std::string title_of_structure(std::string_view structure);

}  // namespace insonate
