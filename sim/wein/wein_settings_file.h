#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/model/settings_file.h"
#include "sim/wein/wein_settings.h"

namespace insonate {

/// Reads model W's settings from a TOML file:
///
///     samples = 192
///     dark_hu = -60
///     shadows = false
///
/// A key is the name of a field of WeinSettings, whose comment gives its unit and range. Fields that the file leaves
/// out keep their defaults. Throws one InputError that names every unknown key, wrong type and value out of range with
/// its line and column.
WeinSettings read_wein_settings(const std::filesystem::path& toml_file);

/// Returns what is wrong with settings, as the problem part of an InputError; empty if every field is within its range.
std::optional<std::string> why_not_valid(const WeinSettings& settings);

/// Returns every setting by its name, in the order of WeinSettings.
std::vector<std::pair<std::string, SettingValue>> named_settings(const WeinSettings& settings);

}  // namespace insonate
