#include "app/panels/learners/score_chart.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/panels/widgets/widgets.h"
#include "scenarios/words.h"

namespace insonate::ui {
namespace {

constexpr ImU32 kBand = IM_COL32(74, 190, 204, 46);  // the accent, faint: marks are seen on it

/// Where attempts and scores lie on the screen.
struct Axes {
  Rect plot;
  std::size_t attempts = 1;

  float x(std::size_t ordinal) const { return plot.x + plot.w * (float(ordinal) + 0.5f) / float(attempts); }
  float y(double percent) const { return plot.y + plot.h * float(1 - std::clamp(percent, 0.0, 100.0) / 100); }
  ImVec2 at(std::size_t ordinal, double percent) const { return {x(ordinal), y(percent)}; }
};

/// Draws the mark of an attempt: its shape is the mode, and it is full if the attempt passed.
void draw_mark(const ImVec2& at, float radius, AttemptMode mode, bool passed, float line) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImU32 ink = passed ? colour::kAccent : colour::kText, inside = passed ? colour::kAccent : colour::kBackground;
  switch (mode) {
    case AttemptMode::exam: {
      const float r = radius * 0.95f;
      list->AddRectFilled({at.x - r, at.y - r}, {at.x + r, at.y + r}, inside);
      list->AddRect({at.x - r, at.y - r}, {at.x + r, at.y + r}, ink, 0, 0, line);
      break;
    }
    case AttemptMode::practice:
      list->AddCircleFilled(at, radius, inside, 20);
      list->AddCircle(at, radius, ink, 20, line);
      break;
    case AttemptMode::recording: {
      const float r = radius * 1.25f;
      list->AddQuadFilled({at.x, at.y - r}, {at.x + r, at.y}, {at.x, at.y + r}, {at.x - r, at.y}, inside);
      list->AddQuad({at.x, at.y - r}, {at.x + r, at.y}, {at.x, at.y + r}, {at.x - r, at.y}, ink, line);
      break;
    }
  }
}

void draw_dashes(float y, float left, float right, float dash, ImU32 ink, float thickness) {
  for (float x = left; x < right; x += 2 * dash)
    ImGui::GetWindowDrawList()->AddLine({x, y}, {std::min(x + dash, right), y}, ink, thickness);
}

/// Returns every how many attempts the axis has a number, so that numbers do not run into each other.
std::size_t label_step(const Theme& theme, const Axes& axes) {
  const float least = text_width(theme.small_text, "000") + theme.px(8);
  std::size_t step = 1;
  for (const std::size_t next : {2, 5, 10, 20, 50, 100, 200, 500, 1000, 10000})
    if (axes.plot.w * float(step) / float(axes.attempts) < least) step = next;
  return step;
}

void draw_grid(const Theme& theme, const Axes& axes, const ScoreTrend& trend) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const Rect& plot = axes.plot;
  const float line = theme.px(18);
  for (const int percent : {0, 50, 100}) {
    const float y = std::round(axes.y(percent));
    list->AddLine({plot.x, y}, {plot.x + plot.w, y}, colour::kLine, 1);
    draw_text({plot.x - theme.px(52), y - line / 2, theme.px(44), line}, theme.small_text, colour::kFaint,
              std::to_string(percent) + " %", Align::right);
  }
  const std::size_t step = label_step(theme, axes);
  for (std::size_t i = 0; i < axes.attempts; ++i) {
    if (i != 0 && (i + 1) % step != 0) continue;
    if (i == 0 && step > 1 && axes.x(step - 1) - axes.x(0) < theme.px(28)) continue;
    const Rect label{axes.x(i) - theme.px(20), plot.y + plot.h + theme.px(9), theme.px(40), line};
    draw_text(label, theme.small_text, colour::kFaint, std::to_string(i + 1), Align::centre);
  }
  if (trend.pass_mark_percent)
    draw_dashes(std::round(axes.y(*trend.pass_mark_percent)), plot.x, plot.x + plot.w, theme.px(5), colour::kMuted,
                theme.px(1.5f));
}

void draw_spreads(const Theme& theme, const Axes& axes, const std::vector<TrendSpread>& spreads) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const float half = axes.plot.w / float(axes.attempts) / 2;
  for (std::size_t i = 0; i < spreads.size(); ++i) {
    const TrendSpread& spread = spreads[i];
    const float x = axes.x(spread.ordinal), width = std::min(half * 0.8f, theme.px(28));
    list->AddRectFilled({x - width, axes.y(spread.percent.third_quartile)},
                        {x + width, axes.y(spread.percent.first_quartile)}, kBand, theme.px(3));
    list->AddLine({x - width, axes.y(spread.percent.median)}, {x + width, axes.y(spread.percent.median)},
                  colour::kAccent, theme.px(2.5f));
    if (i > 0 && spreads[i - 1].ordinal + 1 == spread.ordinal)
      list->AddLine({axes.x(spread.ordinal - 1) + width, axes.y(spreads[i - 1].percent.median)},
                    {x - width, axes.y(spread.percent.median)}, colour::kAccent, theme.px(1));
  }
}

/// What a mark or a line means.
struct LegendEntry {
  LegendEntry(std::string_view its_text, float its_room, std::function<void(const ImVec2&)> its_key)
      : text(its_text), room(its_room), draw_key(std::move(its_key)) {}

  std::string_view text;
  float room;                                   ///< width of the key
  std::function<void(const ImVec2&)> draw_key;  ///< at its middle
};

/// Returns the entries of what the chart has.
/// @param pass_mark  text of the pass mark's entry
std::vector<LegendEntry> legend_of(const Theme& theme, const ScoreTrend& trend, std::string_view pass_mark) {
  std::vector<LegendEntry> entries;
  const float room = theme.px(14), radius = theme.px(4.5f), line = theme.px(1.5f);
  const auto add_mode = [&](AttemptMode mode, const char* name) {
    if (std::any_of(trend.points.begin(), trend.points.end(), [&](const TrendPoint& p) { return p.mode == mode; }))
      entries.emplace_back(name, room, [=](const ImVec2& at) { draw_mark(at, radius, mode, false, line); });
  };
  add_mode(AttemptMode::exam, "exam");
  add_mode(AttemptMode::practice, "practice");
  add_mode(AttemptMode::recording, "recorded scan");
  const AttemptMode newest = trend.points.back().mode;
  entries.emplace_back("filled: passed", room, [=](const ImVec2& at) { draw_mark(at, radius, newest, true, line); });
  if (trend.pass_mark_percent) {
    const float dash = theme.px(5);
    entries.emplace_back(pass_mark, 5 * dash, [=](const ImVec2& at) {
      draw_dashes(std::round(at.y), at.x - 2.5f * dash, at.x + 2.5f * dash, dash, colour::kMuted, line);
    });
  }
  if (!trend.spreads.empty()) {
    const float width = theme.px(22), height = theme.px(12), thick = theme.px(2);
    entries.emplace_back("median and quartiles", width, [=](const ImVec2& at) {
      fill({at.x - width / 2, at.y - height / 2, width, height}, kBand, thick);
      fill({at.x - width / 2, at.y - thick / 2, width, thick}, colour::kAccent);
    });
  }
  return entries;
}

/// Draws the legend at the bottom of `where`, in as many lines as it needs, and takes its place off.
void draw_legend(const Theme& theme, Rect& where, const ScoreTrend& trend) {
  const float height = theme.px(20), gap = theme.px(8), between = theme.px(18);
  std::vector<std::vector<LegendEntry>> lines(1);
  float left = where.w;
  const auto width_of = [&](const LegendEntry& entry) {
    return entry.room + gap + text_width(theme.small_text, entry.text) + 1;
  };
  const std::string pass_mark = "pass mark, " + short_number(trend.pass_mark_percent.value_or(0)) + " %";
  for (LegendEntry& entry : legend_of(theme, trend, pass_mark)) {
    const float width = width_of(entry);
    if (width > left && !lines.back().empty()) {
      lines.emplace_back();
      left = where.w;
    }
    left -= width + between;
    lines.back().push_back(std::move(entry));
  }
  Rect legend = where.take_bottom(height * float(lines.size()));
  where.take_bottom(theme.px(6));
  for (const std::vector<LegendEntry>& entries : lines) {
    Rect line = legend.take_top(height);
    for (const LegendEntry& entry : entries) {
      Rect place = line.take_left(width_of(entry));
      line.take_left(between);
      entry.draw_key(place.take_left(entry.room).centre());
      place.take_left(gap);
      draw_text(place, theme.small_text, colour::kMuted, entry.text);
    }
  }
}

}  // namespace

std::int64_t draw_score_chart(const Theme& theme, Rect where, const ScoreTrend& trend, std::int64_t chosen,
                              bool group) {
  if (trend.points.empty()) return 0;
  draw_legend(theme, where, trend);
  fill(where, colour::kBackground, theme.px(4));
  Rect plot = where;
  plot.take_left(theme.px(56));
  plot.take_right(theme.px(12));
  plot.take_top(theme.px(14));
  plot.take_bottom(theme.px(33));
  const Axes axes{plot, std::max<std::size_t>(trend.attempts, 1)};
  draw_text({where.x + theme.px(8), plot.y + plot.h + theme.px(9), theme.px(60), theme.px(18)}, theme.small_text,
            colour::kFaint, "Attempt");
  draw_grid(theme, axes, trend);
  draw_spreads(theme, axes, trend.spreads);

  ImDrawList* list = ImGui::GetWindowDrawList();
  if (!group) {
    // A line joins attempts of one kind: an exam and a practice cannot be compared.
    std::map<AttemptMode, const TrendPoint*> before;
    for (const TrendPoint& point : trend.points) {
      const TrendPoint* const last = std::exchange(before[point.mode], &point);
      if (last)
        list->AddLine(axes.at(last->ordinal, last->percent), axes.at(point.ordinal, point.percent), colour::kHovered,
                      theme.px(1.5f));
    }
  }
  const float radius = std::clamp(plot.w / float(axes.attempts) * 0.4f, theme.px(2.5f), theme.px(group ? 4 : 6));
  const TrendPoint* nearest = nullptr;
  float nearest_px = theme.px(14);
  const ImVec2 pointer = ImGui::GetIO().MousePos;
  const TrendPoint* marked = nullptr;
  for (const TrendPoint& point : trend.points) {
    const ImVec2 at = axes.at(point.ordinal, point.percent);
    if (point.attempt == chosen) marked = &point;
    draw_mark(at, radius, point.mode, point.passed, theme.px(1.5f));
    const float distance = std::hypot(at.x - pointer.x, at.y - pointer.y);
    if (distance < nearest_px) {
      nearest = &point;
      nearest_px = distance;
    }
  }
  if (marked)
    list->AddCircle(axes.at(marked->ordinal, marked->percent), radius + theme.px(5), colour::kText, 24, theme.px(2));
  ImGui::SetCursorScreenPos(where.min());
  const bool clicked = ImGui::InvisibleButton("score_chart", {where.w, where.h});
  if (!ImGui::IsItemHovered() || !nearest) return 0;
  const ImVec2 at = axes.at(nearest->ordinal, nearest->percent);
  draw_tooltip(theme, {at.x - theme.px(10), at.y - theme.px(10), theme.px(20), theme.px(20)},
               "Attempt " + std::to_string(nearest->attempt) + ": " + fixed(nearest->percent, 1) + " %, " +
                   (nearest->passed ? "passed" : "not passed"));
  return clicked ? nearest->attempt : 0;
}

}  // namespace insonate::ui
