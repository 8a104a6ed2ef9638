#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "sim/model/settings.h"

namespace insonate {

/// Reads settings that a person wrote as TOML:
///
///     preset = "paper"                # or "trainer", the default
///     reflection_length_mm = 0.6      # overrides the preset, as all single settings do
///     beam_window = "triangle"
///     tgc_db = [0, 4, 8, 12, 16, 20, 24, 28]
///
/// A key is the name of a field of Settings, whose comment there gives its unit and range; enumerators are texts. The
/// preset is made for the file's own `samples` and `frequency_mhz`. Throws one InputError that names every unknown key,
/// wrong type and value out of range with its line and column.
/// @param frequency_mhz  the probe's frequency, used if the file gives none
/// @param depth_mm       imaging depth, which presets depend on
Settings read_settings(const std::filesystem::path& toml_file, double frequency_mhz, double depth_mm);

/// Returns what is wrong with settings, as the problem part of an InputError ("'samples' is 0, not a whole number from
/// 1 to 8192"). Returns nothing if every field is within its range.
std::optional<std::string> why_not_valid(const Settings& settings);

/// The value of a setting in a file; enumerators are texts.
using SettingValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>>;

/// Sets the setting of that name; a whole number also sets a setting that need not be whole. Returns what is wrong, as
/// the problem part of an InputError, and then changes nothing: a value of another kind or out of range. Throws
/// std::invalid_argument for a name that named_settings() does not list.
std::optional<std::string> set_setting(Settings& settings, const std::string& name, const SettingValue& value);

/// Returns every setting with its name, in the order of Settings.
std::vector<std::pair<std::string, SettingValue>> named_settings(const Settings& settings);

}  // namespace insonate
