#pragma once

#include <map>
#include <optional>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/trainer/trainer.h"

namespace insonate::ui {

/// The sheets that lie over the whole screen until they are answered. One is drawn at a time.

/// Begins a sheet in the middle of a dimmed screen, until end_overlay(). Nothing below it takes the mouse.
Rect begin_overlay(const Theme& theme, const Rect& screen, const ImVec2& size);
void end_overlay();

/// Draws what is being loaded. Returns true when the person stops it, which is offered if `can_stop`.
/// @param places  receives the button's rectangle
bool draw_loading(const Theme& theme, const Rect& screen, const Loading::Progress& progress, bool can_stop,
                  std::map<std::string, Rect>& places);

/// Draws a problem. Returns true when it is acknowledged.
/// @param ends  the trainer ends after it
bool draw_problem(const Theme& theme, const Rect& screen, const std::string& problem, bool ends);

/// Draws version, commit, licence and device. Returns true when it is closed.
/// @param device  OpenGL's name of the device
bool draw_about(const Theme& theme, const Rect& screen, const std::string& device);

enum class BriefingAnswer { none, start, leave };
/// Draws what the learner reads before a scenario: the briefing, and the exam's steps, time and pass mark.
/// @param counts  the exam counts
/// @param learner  who is learning; empty for nobody in particular
/// @param places  receives the rectangles of the buttons and of the learner's id
BriefingAnswer draw_briefing(const Theme& theme, const Rect& screen, const Scenario& scenario, bool counts,
                             const std::string& learner, std::map<std::string, Rect>& places);

/// Asks whether to leave what is lost by it. Returns the answer once there is one.
/// @param ends   the program ends by it
/// @param steps  steps are not finished
/// @param sweep  what becomes of a sweep; empty if there is nothing to lose
/// @param places  receives the buttons' rectangles
std::optional<bool> draw_leave(const Theme& theme, const Rect& screen, bool ends, bool steps, std::string_view sweep,
                               std::map<std::string, Rect>& places);

}  // namespace insonate::ui
