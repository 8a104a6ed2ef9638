#pragma once

#include "app/panels/replay/timeline_panel.h"
#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/replay/replay.h"

namespace insonate::ui {

/// Draws charts against time: the speed and, if the step names a view, the picture's distance from it, with the
/// expert's curves beside them.
/// @param names  left of `plot`, of the same height: the names of the curves and their current values
/// @param views  whether the scenario has views to find
void draw_replay_charts(const Theme& theme, const Rect& names, const Rect& plot, const TimeScale& scale,
                        const Replay& replay, bool views);

}  // namespace insonate::ui
