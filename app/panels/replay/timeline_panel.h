#pragma once

#include <map>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/replay/replay.h"
#include "scenarios/scenario.h"

namespace insonate::ui {

/// Where a replay's times lie across the screen: its time line and the charts below it share this.
struct TimeScale {
  float left = 0, width = 1;  ///< pixels
  double duration_s = 1;

  float x(double time_s) const { return left + width * float(time_s / duration_s); }
  double time_s(float x) const { return duration_s * double((x - left) / width); }
};

/// A replay's buttons, its time line with steps, marks and what was done, and the charts below; the time is dragged
/// anywhere on the line or the charts. `places` is told where the parts are.
/// @param scenario  of the run; nullptr without one
void draw_timeline_panel(const Theme& theme, const Rect& panel, Replay& replay, const Scenario* scenario,
                         std::map<std::string, Rect>& places);

/// "1:04.2"
std::string clock_text_fine(double seconds);

}  // namespace insonate::ui
