#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"

namespace insonate::ui {

/// A row of a list: a title, and what is to be known about it behind or below.
struct ListRow {
  std::string id, title, about;
};

/// Draws a list that scrolls, one line per row. It scrolls to a row that has been chosen by other means. Returns which
/// row was clicked. Adds the positions of the rows that are seen to `places`.
std::optional<std::size_t> draw_list(const Theme& theme, const char* id, const Rect& where,
                                     const std::vector<ListRow>& rows, std::optional<std::size_t> chosen,
                                     std::map<std::string, Rect>& places);

/// Height of a row, for a screen of 1280 x 800.
inline constexpr float kListRow = 34;

}  // namespace insonate::ui
