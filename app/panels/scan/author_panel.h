#pragma once

#include <map>
#include <string>

#include "app/panels/widgets/text_field.h"
#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/trainer/trainer.h"

namespace insonate::ui {

/// Returns the height of the strip that draw_author_panel() draws, pixels.
float author_panel_height(const Theme& theme);

/// Draws the strip that turns the frozen picture into a view: its title, what it must show, and the button that stores
/// it. Needs Trainer::author(). Adds the positions of its buttons to `places`.
void draw_author_panel(const Theme& theme, const Rect& panel, Trainer& trainer, TextField& field,
                       std::map<std::string, Rect>& places);

}  // namespace insonate::ui
