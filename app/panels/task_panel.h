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

/// Whether the exam has a task panel: one of a log has none, as nobody does anything in it.
bool has_task_panel(const Session& session);

/// As high as the exam needs it all along, so that the picture keeps its size.
float task_panel_height(const Theme& theme, const Session& session, float width);

/// The strip below the exam's: what the learner can do in the step under way, hints, and going on. Adds to `places`
/// where its buttons are.
void draw_task_panel(const Theme& theme, const Rect& panel, Session& session, PictureTools& tools,
                     StepControls& controls, TextField& field, std::map<std::string, Rect>& places);

}  // namespace insonate::ui
