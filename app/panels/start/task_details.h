#pragma once

#include <map>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/trainer/folder_list.h"
#include "app/trainer/start_page.h"

namespace insonate::ui {

/// What a click on the start page asks for.
struct StartAnswer {
  enum class Kind { none, begin, help, settings, about, browse, reset };
  Kind kind = Kind::none;
  Wanted wanted = Wanted::anything;  ///< what to browse for, or to reset
};

/// The words for a task of the start page.
struct TaskText {
  Task task;
  const char* title;
  const char* summary;
  const char* begin;
};
const TaskText& text_of(Task task);

/// Draws the details of the chosen task: what it is, what can be chosen for it, and the button that begins it.
/// @param places  receives the positions of what can be clicked, by name
StartAnswer draw_task(const Theme& theme, const Rect& panel, StartPage& page, std::map<std::string, Rect>& places);

}  // namespace insonate::ui
