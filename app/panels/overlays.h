#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/trainer/trainer.h"

namespace insonate::ui {

/// What lies over the whole screen until it is answered; drawn one at a time.

/// A sheet in the middle of a dimmed screen, from begin_overlay to end_overlay; nothing below it takes the mouse.
Rect begin_overlay(const Theme& theme, const Rect& screen, const ImVec2& size);
void end_overlay();

/// True when it is to be given up, which is offered when it `can_stop`.
bool draw_loading(const Theme& theme, const Rect& screen, const Loading::Progress& progress, bool can_stop);

/// True when it was acknowledged.
/// @param ends  there is nothing to go on with
bool draw_problem(const Theme& theme, const Rect& screen, const std::string& problem, bool ends);

enum class HelpAnswer { none, close, about };
/// Keys and mouse, and the way to the About page.
/// @param places  gets where its button for that page is
HelpAnswer draw_key_help(const Theme& theme, const Rect& screen, std::map<std::string, Rect>& places);

/// Which build of Insonate this is, and what it is not. True when it was closed.
/// @param device  what OpenGL draws on
bool draw_about(const Theme& theme, const Rect& screen, const std::string& device);

/// Asks for a path to open; files may be dropped on the window as well.
class OpenDialog {
public:
  enum class Answer { none, cancelled, chosen };
  Answer draw(const Theme& theme, const Rect& screen);
  std::string path() const { return path_.data(); }

  /// Whether the field takes what is typed.
  bool ready() const { return ready_; }
  /// The next draw() answers `chosen`, with what was typed until then.
  void confirm() { confirmed_ = true; }
  /// To be called when it is no longer drawn.
  void close() { ready_ = confirmed_ = false; }

private:
  std::array<char, 1024> path_{};
  bool ready_ = false, confirmed_ = false;
};

}  // namespace insonate::ui
