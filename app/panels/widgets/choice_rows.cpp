#include "app/panels/widgets/choice_rows.h"

#include <algorithm>

namespace insonate::ui {
namespace {

float width_of(const Theme& theme, const Choice& choice) {
  return std::max(text_width(theme.text, choice.text) + theme.px(28), theme.px(64));
}

}  // namespace

std::optional<std::size_t> row_of_choices(const Theme& theme, Rect row, const std::vector<Choice>& choices,
                                          std::map<std::string, Rect>& places) {
  const float gap = theme.px(8);
  std::vector<float> widths;
  float sum = -gap;
  for (const Choice& choice : choices) {
    widths.push_back(width_of(theme, choice));
    sum += widths.back() + gap;
  }
  const float gaps = gap * float(choices.size() - 1);
  const float shrink = std::min(1.0f, (row.w - gaps) / (sum - gaps));
  std::optional<std::size_t> clicked;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const Rect where = row.take_left(widths[i] * shrink);
    row.take_left(gap);
    places[choices[i].id] = where;
    if (button(theme, choices[i].id.c_str(), where, choices[i].text, choices[i].kind, choices[i].enabled)) clicked = i;
  }
  return clicked;
}

std::optional<std::size_t> flow_of_choices(const Theme& theme, const Rect& where, const std::vector<Choice>& choices,
                                           std::map<std::string, Rect>& places) {
  const float gap = theme.px(8), step = theme.px(kSecondChoiceRow), more = theme.px(40);
  Rect row{where.x, where.y, where.w, theme.px(kChoiceRow)};
  std::optional<std::size_t> clicked;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const Choice& choice = choices[i];
    const float width = width_of(theme, choice);
    const bool last_row = row.y + step + row.h > where.y + where.h + 1;
    const bool fits = width <= row.w - (last_row && i + 1 < choices.size() ? more : 0);
    if (!fits && last_row) {
      draw_text(row, theme.text, colour::kMuted, "+" + std::to_string(choices.size() - i));
      break;
    }
    if (!fits) row = {where.x, row.y + step, where.w, row.h};
    const Rect place = row.take_left(width);
    row.take_left(gap);
    places[choice.id] = place;
    if (button(theme, choice.id.c_str(), place, choice.text, choice.kind, choice.enabled)) clicked = i;
  }
  return clicked;
}

float height_of_flow(const Theme& theme, float width, const std::vector<Choice>& choices) {
  const float gap = theme.px(8);
  float left = width;
  int rows = 1;
  for (const Choice& choice : choices) {
    const float wide = width_of(theme, choice);
    if (wide > left && left < width) {
      ++rows;
      left = width;
    }
    left -= wide + gap;
  }
  return theme.px(kChoiceRow) + float(rows - 1) * theme.px(kSecondChoiceRow);
}

bool need_two_rows(const Theme& theme, float width, const std::vector<std::string>& texts) {
  float sum = 0;
  for (const std::string& text : texts) sum += text_width(theme.text, text) + theme.px(36);
  return texts.size() > 1 && sum > width;
}

std::optional<std::size_t> rows_of_choices(const Theme& theme, Rect where, const std::vector<Choice>& choices,
                                           std::map<std::string, Rect>& places) {
  std::vector<std::string> texts;
  for (const Choice& choice : choices) texts.push_back(choice.text);
  const Rect upper_row = where.take_top(theme.px(kChoiceRow));
  if (!need_two_rows(theme, where.w, texts)) return row_of_choices(theme, upper_row, choices, places);
  const auto half = std::ptrdiff_t(choices.size() + 1) / 2;
  const auto upper = row_of_choices(theme, upper_row, {choices.begin(), choices.begin() + half}, places);
  where.take_top(theme.px(kSecondChoiceRow - kChoiceRow));
  const Rect lower_row = where.take_top(theme.px(kChoiceRow));
  const auto lower = row_of_choices(theme, lower_row, {choices.begin() + half, choices.end()}, places);
  if (lower) return *lower + std::size_t(half);
  return upper;
}

}  // namespace insonate::ui
