#pragma once

#include <map>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/session/session.h"

namespace insonate::ui {

/// Returns the height that the strip at the top needs: more for an instruction that does not fit into one line.
float exam_panel_height(const Theme& theme, float width, const Session* session);

/// Draws the strip at the top: the current step, its progress, the time left, and the tracker's state.
/// @param makes_views  true while reference views are being made
/// @param learner  who is learning; empty for nobody in particular
/// @param places  receives the rectangle of the learner's id
void draw_exam_panel(const Theme& theme, const Rect& panel, const Session& session, bool makes_views,
                     const std::string& learner, std::map<std::string, Rect>& places);

/// Returns sentences on what to do about a tracker whose samples are being rejected; empty while none are.
std::string rejection_advice(const TrackerState& state);

/// Returns a time in minutes and seconds: "1:04".
std::string clock_text(double seconds);

}  // namespace insonate::ui
