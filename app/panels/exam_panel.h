#pragma once

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/session/session.h"

namespace insonate::ui {

/// The strip on top: what is asked for now, how far the hold is, the time, and where the poses come from.
/// @param makes_views  whether the patient's views are being made, in place of practice
void draw_exam_panel(const Theme& theme, const Rect& panel, const Session& session, bool makes_views);

/// What to do about a tracker whose samples are being rejected, as sentences; empty while none are.
std::string rejection_advice(const TrackerState& state);

/// "1:04"
std::string clock_text(double seconds);

}  // namespace insonate::ui
