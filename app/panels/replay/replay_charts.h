#pragma once

#include "app/panels/replay/timeline_panel.h"
#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/replay/replay.h"

namespace insonate::ui {

/// An expert's lines, in charts and in space: neither the accent of what is looked at nor a warning.
inline constexpr ImU32 kExpertInk = IM_COL32(226, 214, 244, 255);

/// Speed, and where the step names a view how far the picture is from it, against time; the expert's beside them.
/// @param names  left of `plot`, of the same height: what is drawn, and the values now
/// @param views  whether there is a scenario whose views are to be found
void draw_replay_charts(const Theme& theme, const Rect& names, const Rect& plot, const TimeScale& scale,
                        const Replay& replay, bool views);

}  // namespace insonate::ui
