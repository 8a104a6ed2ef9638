#pragma once

#include <map>
#include <optional>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/trainer/folder_list.h"
#include "app/trainer/preferences.h"

namespace insonate::ui {

/// What a click on the settings page asks for.
struct SettingsAnswer {
  std::optional<Preferences> wanted;  ///< to be taken at once
  std::optional<Wanted> browse;       ///< a folder or file to look for
  bool close = false;
};

/// Draws the person's preferences with a choice for each. Where the command line names something else, that is shown.
/// @param options  what is used now
/// @param kept_in  the file that stores them; empty if there is none
/// @param places   receives the buttons' rectangles
SettingsAnswer draw_settings(const Theme& theme, const Rect& screen, const Preferences& preferences,
                             const Options& options, const std::filesystem::path& kept_in,
                             std::map<std::string, Rect>& places);

}  // namespace insonate::ui
