#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"

namespace insonate::ui {

/// Heights of a row of choices, and of the second one with the gap above it.
inline constexpr float kChoiceRow = 34, kSecondChoiceRow = 40;

struct Choice {
  std::string id, text;
  ButtonKind kind = ButtonKind::normal;
  bool enabled = true;
};

/// Buttons side by side, narrower where they would not fit; which one was clicked. Adds to `places` where they are.
std::optional<std::size_t> row_of_choices(const Theme& theme, Rect row, const std::vector<Choice>& choices,
                                          std::map<std::string, Rect>& places);

/// In as many rows as they need and there is room for; how many there is no room for is said behind the last.
std::optional<std::size_t> flow_of_choices(const Theme& theme, const Rect& where, const std::vector<Choice>& choices,
                                           std::map<std::string, Rect>& places);

/// Whether texts are too long for buttons in one row.
bool need_two_rows(const Theme& theme, float width, const std::vector<std::string>& texts);

/// In one row, or in two where one is too short for all of them to be read.
std::optional<std::size_t> rows_of_choices(const Theme& theme, Rect where, const std::vector<Choice>& choices,
                                           std::map<std::string, Rect>& places);

}  // namespace insonate::ui
