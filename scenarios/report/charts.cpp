#include "scenarios/report/charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "scenarios/report/svg.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

// All lengths are in the drawing's own units, which are pixels on a screen.
constexpr double kWidth = 760;
constexpr double kLeft = 46;
constexpr double kRight = 12;
constexpr double kTop = 26;
constexpr double kChartHeight = 92;
constexpr double kChartGap = 34;
constexpr double kAxisHeight = 26;

/// One of the charts over time.
struct Quantity {
  const char* title;
  double most;                 ///< end of the axis; larger values are clipped
  std::optional<Metric> mark;  ///< draws the value that earns full points for this criterion
  std::function<double(const TracePoint&)> value;
};

/// Maps a chart's values to positions in the drawing.
struct Axes {
  double top;
  double duration_s;
  double most;

  double x(double time_s) const { return kLeft + (kWidth - kLeft - kRight) * time_s / duration_s; }
  double y(double value) const { return top + kChartHeight * (1 - std::clamp(value / most, 0.0, 1.0)); }
};

/// Whether a step compares the picture with a view; in others, the values of a view are not known.
bool has_view(const ExamResult& result, std::size_t step) {
  return step < result.steps.size() && !result.steps[step].view.empty();
}

std::string curve(const Quantity& quantity, const Axes& axes, const ExamResult& result,
                  std::span<const TracePoint> trace) {
  std::string path;
  std::optional<std::size_t> drawing;  // the step: the next one is compared with another view
  for (const TracePoint& point : trace) {
    const bool is_known = point.valid && (!quantity.mark || has_view(result, point.step));
    const bool goes_on = drawing && (!quantity.mark || *drawing == point.step);
    if (is_known)
      path += formatted("%c%.1f %.1f", goes_on ? 'L' : 'M', axes.x(point.time_s), axes.y(quantity.value(point)));
    drawing = is_known ? std::optional(point.step) : std::nullopt;
  }
  return "<path class='curve' d='" + path + "'/>";
}

/// Grey bars for the times without a pose.
std::string untracked(const Axes& axes, std::span<const TracePoint> trace) {
  std::string bars;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    if (trace[i].valid) continue;
    const std::size_t first = i;
    while (i + 1 < trace.size() && !trace[i + 1].valid) ++i;
    const double end = i + 1 < trace.size() ? trace[i + 1].time_s : axes.duration_s;
    bars += formatted("<rect class='lost' x='%.1f' y='%.1f' width='%.1f' height='%.1f'/>", axes.x(trace[first].time_s),
                      axes.top, std::max(1.0, axes.x(end) - axes.x(trace[first].time_s)), kChartHeight);
  }
  return bars;
}

std::string steps_on(const Axes& axes, const ExamResult& result, const std::optional<Metric>& shown) {
  std::string svg;
  for (const StepResult& step : result.steps) {
    if (step.judged_from_s && step.judged_to_s)
      svg += formatted("<rect class='%s' x='%.1f' y='%.1f' width='%.1f' height='%.1f'/>",
                       is_done(step.outcome) ? "held" : "judged", axes.x(*step.judged_from_s), axes.top,
                       std::max(2.0, axes.x(*step.judged_to_s) - axes.x(*step.judged_from_s)), kChartHeight);
    if (step.start_s > 0 && step.outcome != StepOutcome::not_reached)
      svg += formatted("<line class='step' x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>", axes.x(step.start_s),
                       axes.x(step.start_s), axes.top, axes.top + kChartHeight);
    for (const CriterionScore& m : step.criteria)
      if (m.metric == shown && step.end_s > step.start_s)
        svg += formatted("<line class='full' x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>", axes.x(step.start_s),
                         axes.x(step.end_s), axes.y(m.full), axes.y(m.full));
  }
  return svg;
}

std::string scale(const Quantity& quantity, const Axes& axes, std::span<const TracePoint> trace) {
  const bool cut = std::any_of(trace.begin(), trace.end(), [&](const TracePoint& point) {
    return point.valid && quantity.value(point) > axes.most;
  });
  std::string svg = formatted("<text class='name' x='%.0f' y='%.1f'>%s</text>", kLeft, axes.top - 7, quantity.title);
  for (const double share : {0.0, 0.5, 1.0}) {
    const double value = share * axes.most;
    svg += formatted("<line class='grid' x1='%.0f' x2='%.0f' y1='%.1f' y2='%.1f'/>", kLeft, kWidth - kRight,
                     axes.y(value), axes.y(value));
    svg += formatted("<text class='tick' x='%.0f' y='%.1f' text-anchor='end'>%g%s</text>", kLeft - 6, axes.y(value) + 4,
                     value, share == 1.0 && cut ? "+" : "");
  }
  return svg;
}

std::string time_axis(const Axes& axes) {
  std::string svg;
  const double step = round_step(axes.duration_s);
  const double y = axes.top + kChartHeight + 16;
  for (int tick = 0; tick * step <= axes.duration_s; ++tick)
    svg += formatted("<text class='tick' x='%.1f' y='%.1f' text-anchor='middle'>%g%s</text>", axes.x(tick * step), y,
                     tick * step, tick == 0 ? " s" : "");
  return svg;
}

}  // namespace

std::string time_charts_svg(const ExamResult& result, std::span<const TracePoint> trace) {
  if (trace.empty()) return "";
  double fastest = 0;
  for (const TracePoint& point : trace)
    if (point.valid) fastest = std::max(fastest, point.speed_mm_s);
  const std::array quantities{
      Quantity{"Distance of the target from the plane, mm", 40, Metric::plane_distance_mm,
               [](const TracePoint& p) { return std::abs(p.view.plane_distance_mm); }},
      Quantity{"Angle to the reference plane, degrees", 90, Metric::plane_angle_deg,
               [](const TracePoint& p) { return p.view.plane_angle_deg; }},
      Quantity{"Target reached by the sound, % of the reference view", 120, Metric::target_insonated_percent,
               [](const TracePoint& p) { return p.view.target_insonated_percent; }},
      Quantity{"Speed of the probe, mm/s", 100 * std::max(1.0, std::ceil(fastest / 100)), std::nullopt,
               [](const TracePoint& p) { return p.speed_mm_s; }}};

  const double height = kTop + quantities.size() * (kChartHeight + kChartGap) - kChartGap + kAxisHeight;
  std::string svg = formatted("<svg class='chart' viewBox='0 0 %.0f %.0f' role='img'>", kWidth, height);
  Axes axes{kTop, std::max(1.0, result.motion.time_s), 1};
  for (const Quantity& quantity : quantities) {
    axes.most = quantity.most;
    svg += steps_on(axes, result, quantity.mark) + untracked(axes, trace) + scale(quantity, axes, trace) +
           curve(quantity, axes, result, trace);
    axes.top += kChartHeight + kChartGap;
  }
  axes.top -= kChartHeight + kChartGap;
  return svg + time_axis(axes) + "</svg>";
}

}  // namespace insonate
