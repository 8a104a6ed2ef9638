#pragma once

#include <map>
#include <string>

#include "app/panels/widgets/text_field.h"
#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/trainer/trainer.h"

namespace insonate::ui {

float author_panel_height(const Theme& theme);

/// The strip in which a view is made of the frozen picture: its title, what it must show, and keeping it. Needs
/// Trainer::author(). Adds to `places` where its buttons are.
void draw_author_panel(const Theme& theme, const Rect& panel, Trainer& trainer, TextField& field,
                       std::map<std::string, Rect>& places);

}  // namespace insonate::ui
