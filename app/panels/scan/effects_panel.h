#pragma once

#include <map>
#include <string>

#include "app/panels/widgets/widgets.h"
#include "app/session/session.h"

namespace insonate::ui {

/// Draws the effects of the model (sim/model/effects.h) as switches and sliders, and a button that takes all changes
/// back. Returns true if the person closes the panel.
/// @param places  receives the places of the buttons
bool draw_effects_panel(const Theme& theme, const Rect& panel, Session& session, std::map<std::string, Rect>& places);

}  // namespace insonate::ui
