#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/trainer/folder_list.h"

namespace insonate::ui {

/// Lets a person find a file or folder: a list to click through, and a field to type into. Files can be dropped on the
/// window as well.
class OpenDialog {
public:
  /// Begins to look for something, in the folder of the last time.
  void open(Wanted wanted);

  enum class Answer { none, cancelled, chosen };
  /// Draws the dialog. Adds the positions of its buttons and of the rows that are seen to `places`.
  Answer draw(const Theme& theme, const Rect& screen, std::map<std::string, Rect>& places);
  /// Returns what was chosen.
  std::filesystem::path path() const { return typed_path(path_.data()); }
  Wanted wanted() const { return wanted_; }

  /// Returns whether the field accepts characters.
  bool ready() const { return ready_; }
  /// Puts the entry so many below the chosen one into the field; the first if none is chosen.
  void move_choice(int by);
  /// Makes the next draw() take what was typed until then: a folder is gone into, anything else is `chosen`.
  void confirm() { confirmed_ = true; }
  /// Call it when the dialog is no longer drawn.
  void close() { ready_ = confirmed_ = false; }

private:
  void go_to(const std::filesystem::path& folder);
  void put(const std::filesystem::path& path);
  void draw_field(const Theme& theme, const Rect& field);
  /// Draws the list. Returns whether an entry was chosen by a double click.
  bool draw_entries(const Theme& theme, const Rect& where, std::map<std::string, Rect>& places);

  Wanted wanted_ = Wanted::anything;
  FolderList list_;
  std::array<char, 4096> path_{};
  int texts_ = 0;  ///< how often another text was put into the field
  bool ready_ = false, confirmed_ = false;
};

}  // namespace insonate::ui
