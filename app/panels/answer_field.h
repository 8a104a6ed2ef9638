#pragma once

#include <array>

#include "app/panels/theme.h"
#include "app/panels/widgets.h"
#include "app/step_controls.h"

namespace insonate::ui {

/// The field for answers that are typed: a number with its unit, or a text. Closed it shows what was typed; a click
/// opens it, and then it takes the keys.
class AnswerField {
public:
  void draw(const Theme& theme, const Rect& where, StepControls& controls);
  /// It is typed into, or will be from one of the next frames on.
  bool is_open() const { return open_; }
  /// Whether it takes what is typed.
  bool ready() const { return ready_; }
  void open() { open_ = true; }
  /// What was typed stays.
  void close() { open_ = ready_ = false; }

private:
  std::array<char, Action::kLongestText + 1> typed_{};
  bool open_ = false, ready_ = false, filled_ = false;
};

}  // namespace insonate::ui
