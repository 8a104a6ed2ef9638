#pragma once

#include <map>
#include <string>

#include "app/panels/widgets/text_field.h"
#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/session/picture_tools.h"
#include "app/session/session.h"
#include "app/session/step_controls.h"

namespace insonate::ui {

/// Returns whether the exam has a task panel. An exam that a log plays has none.
bool has_task_panel(const Session& session);

/// Returns the height that the current step needs for its controls and words.
float task_panel_height(const Theme& theme, const Session& session, const PictureTools& tools,
                        const StepControls& controls, float width);

/// Draws the strip below the exam's: the controls of the current step, hints, and going on. Adds its buttons'
/// rectangles to `places`.
void draw_task_panel(const Theme& theme, const Rect& panel, Session& session, PictureTools& tools,
                     StepControls& controls, TextField& field, std::map<std::string, Rect>& places);

}  // namespace insonate::ui
