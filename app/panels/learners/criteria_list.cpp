#include "app/panels/learners/criteria_list.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "app/panels/start/start_list.h"
#include "app/panels/widgets/scroll_area.h"
#include "scenarios/words.h"

namespace insonate::ui {
namespace {

constexpr float kCriterionRow = 44, kWidestBar = 30;

struct CriterionColumns {
  Rect name, bars, lost;
};

/// @param attempts  how many bars there are at most
CriterionColumns columns_of(const Theme& theme, Rect row, std::size_t attempts) {
  CriterionColumns columns;
  columns.lost = row.take_right(theme.px(84));
  row.take_right(theme.px(14));
  const float bars = std::clamp(theme.px(kWidestBar) * float(attempts), theme.px(84), row.w * 0.38f);
  columns.bars = row.take_right(std::round(bars));
  row.take_right(theme.px(14));
  columns.name = row;
  return columns;
}

/// Draws a bar per attempt, the newest on the right. Of more attempts than fit, the newest are shown.
void draw_bars(const Theme& theme, const Rect& where, const CriterionTrend& trend) {
  const auto fitting = std::max<std::size_t>(1, std::size_t(where.w / theme.px(5)));
  const std::size_t shown = std::min(trend.shares.size(), fitting), first = trend.shares.size() - shown;
  if (shown == 0) return;
  const float step = std::min(where.w / float(shown), theme.px(kWidestBar)), gap = std::min(theme.px(3), step * 0.3f);
  for (std::size_t i = 0; i < shown; ++i) {
    const std::optional<double>& share = trend.shares[first + i];
    const float left = std::round(where.x + float(i) * step), right = std::round(where.x + float(i + 1) * step - gap);
    const Rect bar{left, where.y, std::max(right - left, 1.0f), where.h};
    if (!share) continue;
    fill(bar, colour::kRaised);
    const float height = std::max(std::round(float(*share) * bar.h), theme.px(3));
    const ImU32 ink = *share >= 0.995 ? colour::kAccent : *share > 0.005 ? colour::kFaint : colour::kAmber;
    fill({bar.x, bar.y + bar.h - height, bar.w, height}, ink);
  }
}

/// Returns how much of a row its criterion's name takes: wrapped, because it says what lost the points.
float name_height(const Theme& theme, const CriterionTrend& trend, float width) {
  return std::max(theme.px(20), paragraph_height(theme.text, info(trend.metric).words, width));
}

void draw_row(const Theme& theme, const Rect& row, const CriterionTrend& trend, std::size_t attempts) {
  const CriterionColumns columns = columns_of(theme, row, attempts);
  Rect name = columns.name.inset(0, theme.px(3));
  draw_paragraph(name.take_top(name_height(theme, trend, name.w)), theme.text, colour::kText, info(trend.metric).words);
  const std::string part =
      trend.step ? std::to_string(*trend.step + 1) + ". " + trend.step_title : std::string("Whole exam");
  draw_text(name.take_top(theme.px(18)), theme.small_text, colour::kMuted, part + (trend.critical ? ", critical" : ""));
  if (trend.critical) draw_tooltip(theme, row, kCriticalMeans);
  Rect bars = columns.bars.inset(0, theme.px(6));
  draw_bars(theme, bars.take_top(theme.px(kCriterionRow - 12)), trend);
  Rect lost = columns.lost.inset(0, theme.px(3));
  const bool much = trend.lost > trend.weight / 2;
  draw_text(lost.take_top(theme.px(20)), theme.strong,
            much             ? colour::kAmber
            : trend.lost > 0 ? colour::kText
                             : colour::kMuted,
            trend.lost > 0 ? "\u2212" + short_number(trend.lost) : "0", Align::right);
  draw_text(lost.take_top(theme.px(18)), theme.small_text, colour::kMuted, "of " + short_number(trend.weight),
            Align::right);
}

}  // namespace

void draw_criteria_list(const Theme& theme, Rect where, const ScoreTrend& trend) {
  if (trend.unread > 0)
    return draw_text(where.take_top(theme.px(24)), theme.text, colour::kMuted,
                     "Reading " + std::to_string(trend.unread) + " scores\u2026");
  if (trend.criteria.empty()) return;
  std::size_t attempts = 0;
  for (const CriterionTrend& criterion : trend.criteria) attempts = std::max(attempts, criterion.shares.size());
  const auto row_height = [&](const CriterionTrend& criterion, float width) {
    const float name = columns_of(theme, {0, 0, width, 0}, attempts).name.w;
    return theme.px(kCriterionRow - 20) + name_height(theme, criterion, name);
  };
  const auto height_of_rows = [&](float width) {
    float height = 0;
    for (const CriterionTrend& criterion : trend.criteria) height += row_height(criterion, width);
    return height;
  };
  const float bar = height_of_rows(where.w) > where.h - theme.px(24) ? theme.px(14) : 0;
  Rect head = where.take_top(theme.px(20));
  head.take_right(bar);
  const CriterionColumns columns = columns_of(theme, head, attempts);
  draw_text(columns.name, theme.small_text, colour::kFaint, "Most lost first");
  draw_text(columns.bars, theme.small_text, colour::kFaint, "Earned");
  draw_text(columns.lost, theme.small_text, colour::kFaint, "Lost points", Align::right);
  where.take_top(theme.px(4));
  if (trend.lost_to_hints > 0) {
    draw_text(where.take_bottom(theme.px(20)), theme.small_text, colour::kMuted,
              "Hints cost " + short_number(trend.lost_to_hints) + " points per attempt.");
    where.take_bottom(theme.px(4));
  }
  const ScrollArea area(theme, "criteria", where, height_of_rows(head.w));
  Rect rest = area.content();
  for (const CriterionTrend& criterion : trend.criteria) {
    const Rect row = rest.take_top(row_height(criterion, rest.w));
    if (!area.shows(row)) continue;
    fill({row.x, row.y, row.w, 1}, colour::kLine);
    draw_row(theme, row, criterion, attempts);
  }
}

}  // namespace insonate::ui
