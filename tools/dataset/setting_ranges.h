#pragma once

#include "sim/files/toml_table.h"
#include "sim/model/settings.h"
#include "tools/dataset/draws.h"
#include "tools/dataset/study.h"

namespace insonate {

/// The size of pictures that a study leaves open, pixels.
inline constexpr int kUsualPictureSide = 512;

/// The value of a field that is true or false, if each image draws one of the two.
inline constexpr const char* kEither = "either";

/// Reads the table [settings] of a study. A key is the name of a field of Settings. It takes one value, a range of a
/// number as [least, most], a list of texts of which one is drawn, and for a field that is true or false kEither.
void read_setting_ranges(const TomlTable& table, Study& study);

/// Returns the settings of one image.
/// @param patient_seed  of the speckle, if the study gives none: a patient's scatterers stay where they are
Settings draw_settings(const Study& study, const Draws& draws, double frequency_mhz, double depth_mm,
                       std::uint32_t patient_seed);

/// Returns false if no image of the study has Settings::waves. Its patients then have no structure in their tissues.
bool may_have_waves(const Study& study);

}  // namespace insonate
