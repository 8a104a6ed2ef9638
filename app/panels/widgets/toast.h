#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"

namespace insonate::ui {

/// Returns whether a file is a page to read, which is opened itself rather than its folder.
inline bool is_page(const std::filesystem::path& file) {
  return file.extension() == ".html";
}

/// A short message over the screen that goes away by itself, such as where a file was written, with a button that shows
/// the file. A new message replaces the one before it.
class Toast {
public:
  /// Long enough to read a sentence and a path.
  static constexpr double kShown_s = 6;

  /// Shows a message from the next frame on.
  /// @param file  that the message is about; empty: none
  void show(std::string text, std::filesystem::path file = {});
  /// Lets the message's time stand still for this frame.
  void wait() { until_s_ += ImGui::GetIO().DeltaTime; }
  void hide() { text_.clear(); }
  /// Whether the message is about a file, which stays where it is when the page changes.
  bool names_file() const { return !file_.empty(); }
  /// Returns the message; empty if none is shown.
  const std::string& text() const { return text_; }
  /// Returns the time until the message goes (s), so that a window which draws only what changes draws once more then;
  /// 0 if none is shown.
  double left_s() const;
  /// Draws the message over everything else, at the bottom of `where`, and drops it when its time is over. Returns the
  /// file if the person asks for its folder; else an empty path.
  /// @param places  receives the button's rectangle
  std::filesystem::path draw(const Theme& theme, const Rect& where, std::map<std::string, Rect>& places);

private:
  std::string text_;
  std::filesystem::path file_;
  double until_s_ = 0;  ///< on ImGui's clock
};

}  // namespace insonate::ui
