#pragma once

#include <array>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "scenarios/action.h"

namespace insonate::ui {

/// A field that a short text or a number is typed into. Closed it shows what was typed; a click opens it, and then it
/// takes the keys.
class TextField {
public:
  /// Returns what is in it now.
  /// @param hint  shown while nothing is
  /// @param unit  of a number, shown behind the field; empty for none
  std::string draw(const Theme& theme, const Rect& where, const std::string& text, const char* hint,
                   const std::string& unit = {});
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
