#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"

namespace insonate::ui {

/// Heights of a row of choices, and of a second row with the gap above it.
inline constexpr float kChoiceRow = 34, kSecondChoiceRow = 40;

struct Choice {
  std::string id, text;
  ButtonKind kind = ButtonKind::normal;
  bool enabled = true;
};

/// Draws buttons side by side, narrower if they would not fit. Returns which one was clicked. Adds their positions to
/// `places`.
std::optional<std::size_t> row_of_choices(const Theme& theme, Rect row, const std::vector<Choice>& choices,
                                          std::map<std::string, Rect>& places);

/// Does the same in as many rows as are needed and fit. The last row ends with the number of choices that do not fit.
std::optional<std::size_t> flow_of_choices(const Theme& theme, const Rect& where, const std::vector<Choice>& choices,
                                           std::map<std::string, Rect>& places);

/// Returns the height of the rows in which all of them fit.
float height_of_flow(const Theme& theme, float width, const std::vector<Choice>& choices);

/// Returns whether texts are too long for buttons in one row.
bool need_two_rows(const Theme& theme, float width, const std::vector<std::string>& texts);

/// Draws one row, or two if one is too short for all texts to be read.
std::optional<std::size_t> rows_of_choices(const Theme& theme, Rect where, const std::vector<Choice>& choices,
                                           std::map<std::string, Rect>& places);

}  // namespace insonate::ui
