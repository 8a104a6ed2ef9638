#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/model/settings_file.h"
#include "sim/registration/wein_settings.h"

namespace insonate {

/// Reads model W's settings that a person wrote as TOML:
///
///     samples = 192
///     dark_hu = -60
///     shadows = false
///
/// A key is the name of a field of WeinSettings, whose comment there gives its unit and range; what the file leaves out
/// stays as it is there. Throws one InputError that names every unknown key, wrong type and value out of range with its
/// line and column.
WeinSettings read_wein_settings(const std::filesystem::path& toml_file);

/// What is wrong with settings, as the problem part of an InputError; empty when every field is within its range.
std::optional<std::string> why_not_valid(const WeinSettings& settings);

/// Every setting by its name, in the order of WeinSettings.
std::vector<std::pair<std::string, SettingValue>> named_settings(const WeinSettings& settings);

}  // namespace insonate
