#pragma once

#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"

namespace insonate::ui {

/// A short message over the screen that goes away by itself, such as where a file was written. A new message replaces
/// the one before it.
class Toast {
public:
  /// Long enough to read a sentence and a path.
  static constexpr double kShown_s = 6;

  /// Shows a message from the next frame on.
  void show(std::string text);
  /// Returns the message; empty if none is shown.
  const std::string& text() const { return text_; }
  /// Returns the time until the message goes (s), so that a window which draws only what changes draws once more then;
  /// 0 if none is shown.
  double left_s() const;
  /// Draws the message over everything else, at the bottom of `where`, and drops it when its time is over.
  void draw(const Theme& theme, const Rect& where);

private:
  std::string text_;
  double until_s_ = 0;  ///< on ImGui's clock
};

}  // namespace insonate::ui
