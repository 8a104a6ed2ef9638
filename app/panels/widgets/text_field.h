#pragma once

#include <string>
#include <vector>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "scenarios/action.h"

namespace insonate::ui {

/// A field into which a short text or a number is typed. Closed, it shows what was typed. A click opens it, and then it
/// takes the keys.
class TextField {
public:
  /// @param longest  bytes of the longest text
  explicit TextField(std::size_t longest = Action::kLongestText) : typed_(longest + 1) {}

  /// Draws the field and returns its current content.
  /// @param hint  shown while the field is empty
  /// @param unit  of a number, shown behind the field; empty for none
  std::string draw(const Theme& theme, const Rect& where, const std::string& text, const char* hint,
                   const std::string& unit = {});
  /// Returns whether it is open: it takes text now or from one of the next frames on.
  bool is_open() const { return open_; }
  /// Returns whether it takes text now.
  bool ready() const { return ready_; }
  void open() { open_ = true; }
  /// Closes the field and keeps what was typed.
  void close() { open_ = ready_ = false; }

private:
  std::vector<char> typed_;  ///< ends with 0
  bool open_ = false, ready_ = false, filled_ = false;
};

}  // namespace insonate::ui
