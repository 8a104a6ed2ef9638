#pragma once

#include <map>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/replay/replay.h"
#include "scenarios/scenario.h"

namespace insonate::ui {

/// Maps a replay's times to screen positions, for its time line and the charts below it.
struct TimeScale {
  float left = 0, width = 1;  ///< pixels
  double duration_s = 1;

  float x(double time_s) const { return left + width * float(time_s / duration_s); }
  double time_s(float x) const { return duration_s * double((x - left) / width); }
};

/// Draws a replay's buttons, its time line with steps, event markers and actions, and the charts below. The time can be
/// dragged anywhere on the line or the charts. Adds the positions of the parts to `places`.
/// @param scenario  of the run; nullptr if it has none
void draw_timeline_panel(const Theme& theme, const Rect& panel, Replay& replay, const Scenario* scenario,
                         std::map<std::string, Rect>& places);

/// Returns the time to a tenth of a second: "1:04.2".
std::string clock_text_fine(double seconds);

}  // namespace insonate::ui
