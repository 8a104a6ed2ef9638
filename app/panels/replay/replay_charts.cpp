#include "app/panels/replay/replay_charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "scenarios/words.h"

namespace insonate::ui {
namespace {

/// One of the charts.
struct Quantity {
  const char* name;
  std::optional<Metric> metric;  ///< of the step's view; empty: the speed
  double most;                   ///< end of the axis

  /// Returns whether values may lie beyond the axis, and are clipped to its end.
  bool clips() const { return metric != Metric::target_insonated_percent; }
  std::optional<double> of(const RunMoment& moment) const {
    if (moment.last_usable_s != moment.time_s) return std::nullopt;
    if (!metric) return moment.speed_mm_s;
    if (!moment.view) return std::nullopt;
    // More of the target than the expert reached counts as all of it.
    const double value = moment.view->of(*metric);
    return metric == Metric::target_insonated_percent ? std::min(value, 100.0) : value;
  }
  std::string words(double value) const { return metric ? in_words(*metric, value) : fixed(value, 0) + " mm/s"; }
};

constexpr std::array kQuantities{
    Quantity{"Plane's distance", Metric::plane_distance_mm, 40}, Quantity{"Plane's angle", Metric::plane_angle_deg, 90},
    Quantity{"Target reached", Metric::target_insonated_percent, 100}, Quantity{"Speed", std::nullopt, 150}};

/// Draws a curve of the largest value within each screen pixel. It is interrupted where there is no value.
/// @param at  maps a time of the run to its place on the time line; empty if it has none
template <typename At>
void draw_curve(const Rect& chart, const TimeScale& scale, const Quantity& quantity, const RecordedRun& run, ImU32 ink,
                float thickness, At&& at) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  float column = -1, highest = 0;
  const auto y = [&](double value) {
    return chart.y + chart.h * float(1 - std::clamp(value / quantity.most, 0.0, 1.0));
  };
  const auto stroke = [&] {
    if (column >= 0) list->PathLineTo({column, highest});
    list->PathStroke(ink, 0, thickness);
    column = -1;
  };
  std::size_t step = run.moments.front().step;
  for (const RunMoment& moment : run.moments) {
    if (std::exchange(step, moment.step) != moment.step) stroke();  // the next step is measured against another view
    const std::optional<double> value = quantity.of(moment), time_s = at(moment.time_s);
    if (!value || !time_s) {
      stroke();
      continue;
    }
    const float x = std::round(scale.x(*time_s));
    if (x == column) {
      highest = std::min(highest, y(*value));
      continue;
    }
    if (column >= 0) list->PathLineTo({column, highest});
    column = x;
    highest = y(*value);
  }
  stroke();
}

std::string value_text(const Quantity& quantity, const RunMoment& moment) {
  const std::optional<double> value = quantity.of(moment);
  return value ? quantity.words(*value) : "\u2013";
}

void draw_chart(const Theme& theme, Rect label, const Rect& chart, const TimeScale& scale, const Quantity& quantity,
                const Replay& replay) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  fill(chart, colour::kBackground, theme.px(2));
  for (const RunStretch& stretch : replay.run().stretches) {
    const float x = std::round(scale.x(stretch.start_s));
    if (stretch.start_s > 0) list->AddLine({x, chart.y}, {x, chart.y + chart.h}, colour::kLine, 1);
  }
  if (const RecordedRun* expert = replay.expert())
    draw_curve(chart, scale, quantity, *expert, colour::kExpert, 1, [&](double t) { return replay.beside_s(t); });
  draw_curve(chart, scale, quantity, replay.run(), colour::kAccent, theme.px(1.5f),
             [](double t) { return std::optional(t); });

  label.take_right(theme.px(6));
  const Rect axis = label.take_right(theme.px(34));
  draw_text({axis.x, chart.y - theme.px(2), axis.w, theme.px(15)}, theme.small_text, colour::kFaint,
            fixed(quantity.most, 0) + (quantity.clips() ? "+" : ""), Align::right);
  draw_text({axis.x, chart.y + chart.h - theme.px(13), axis.w, theme.px(15)}, theme.small_text, colour::kFaint, "0",
            Align::right);
  Rect line{label.x, label.y + (label.h - theme.px(36)) / 2, label.w, theme.px(18)};
  draw_text(line, theme.small_text, colour::kMuted, quantity.name);
  line.y += line.h;
  draw_text(line, theme.small_text, colour::kAccent, value_text(quantity, replay.moment()));
  if (const std::optional<double> expert_s = replay.expert_time_s()) {
    line.take_left(theme.px(76));
    draw_text(line, theme.small_text, colour::kExpert, value_text(quantity, replay.expert()->at(*expert_s)));
  }
}

}  // namespace

void draw_replay_charts(const Theme& theme, const Rect& names, const Rect& plot, const TimeScale& scale,
                        const Replay& replay, bool views) {
  std::span<const Quantity> shown = kQuantities;
  if (!views) shown = shown.last(1);
  const float gap = theme.px(5);
  const float height = (plot.h - gap * float(shown.size() - 1)) / float(shown.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const float y = plot.y + float(i) * (height + gap);
    draw_chart(theme, {names.x, y, names.w, height}, {plot.x, y, plot.w, height}, scale, shown[i], replay);
  }
}

}  // namespace insonate::ui
