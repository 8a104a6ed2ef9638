#pragma once

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/session/session.h"

namespace insonate::ui {

/// Draws the strip at the top: the current step, its progress, the time left, and the tracker's state.
/// @param makes_views  true while reference views are being made
void draw_exam_panel(const Theme& theme, const Rect& panel, const Session& session, bool makes_views);

/// Returns sentences on what to do about a tracker whose samples are being rejected; empty while none are.
std::string rejection_advice(const TrackerState& state);

/// Returns a time in minutes and seconds: "1:04".
std::string clock_text(double seconds);

}  // namespace insonate::ui
