#include "scenarios/report_charts.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <functional>

namespace insonate {
namespace {

/// printf into a string: numbers in SVG want a fixed, short form.
std::string print(const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  char text[512];
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

// All lengths in the drawing's own units, which are pixels on a screen.
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
  double most;                 ///< the axis ends here; what lies beyond is cut
  std::optional<Metric> mark;  ///< the criterion whose full points are drawn
  std::function<double(const TracePoint&)> value;
};

/// Places a chart's values in the drawing.
struct Axes {
  double top;
  double duration_s;
  double most;

  double x(double time_s) const { return kLeft + (kWidth - kLeft - kRight) * time_s / duration_s; }
  double y(double value) const { return top + kChartHeight * (1 - std::clamp(value / most, 0.0, 1.0)); }
};

/// A round number of about a fifth of the span: 1, 2 or 5 times a power of ten.
double round_step(double span) {
  const double power = std::pow(10.0, std::floor(std::log10(span / 5)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (span / (factor * power) <= 7) return factor * power;
  return 10 * power;
}

std::string curve(const Quantity& quantity, const Axes& axes, std::span<const TracePoint> trace) {
  std::string path;
  bool drawing = false;
  for (const TracePoint& point : trace) {
    if (point.valid)
      path += print("%c%.1f %.1f", drawing ? 'L' : 'M', axes.x(point.time_s), axes.y(quantity.value(point)));
    drawing = point.valid;
  }
  return "<path class='curve' d='" + path + "'/>";
}

/// Grey bars where no pose came.
std::string untracked(const Axes& axes, std::span<const TracePoint> trace) {
  std::string bars;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    if (trace[i].valid) continue;
    const std::size_t first = i;
    while (i + 1 < trace.size() && !trace[i + 1].valid) ++i;
    const double end = i + 1 < trace.size() ? trace[i + 1].time_s : axes.duration_s;
    bars += print("<rect class='lost' x='%.1f' y='%.1f' width='%.1f' height='%.1f'/>", axes.x(trace[first].time_s),
                  axes.top, std::max(1.0, axes.x(end) - axes.x(trace[first].time_s)), kChartHeight);
  }
  return bars;
}

std::string steps_on(const Axes& axes, const ExamResult& result, const std::optional<Metric>& shown) {
  std::string svg;
  for (const StepResult& step : result.steps) {
    if (step.judged_from_s && step.judged_to_s)
      svg += print("<rect class='%s' x='%.1f' y='%.1f' width='%.1f' height='%.1f'/>",
                   step.outcome == StepOutcome::held ? "held" : "judged", axes.x(*step.judged_from_s), axes.top,
                   std::max(2.0, axes.x(*step.judged_to_s) - axes.x(*step.judged_from_s)), kChartHeight);
    if (step.start_s > 0 && step.outcome != StepOutcome::not_reached)
      svg += print("<line class='step' x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>", axes.x(step.start_s),
                   axes.x(step.start_s), axes.top, axes.top + kChartHeight);
    for (const Mark& m : step.marks)
      if (m.metric == shown && step.end_s > step.start_s)
        svg += print("<line class='full' x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>", axes.x(step.start_s),
                     axes.x(step.end_s), axes.y(m.full), axes.y(m.full));
  }
  return svg;
}

std::string scale(const Quantity& quantity, const Axes& axes, std::span<const TracePoint> trace) {
  const bool cut = std::any_of(trace.begin(), trace.end(), [&](const TracePoint& point) {
    return point.valid && quantity.value(point) > axes.most;
  });
  std::string svg = print("<text class='name' x='%.0f' y='%.1f'>%s</text>", kLeft, axes.top - 7, quantity.title);
  for (const double share : {0.0, 0.5, 1.0}) {
    const double value = share * axes.most;
    svg += print("<line class='grid' x1='%.0f' x2='%.0f' y1='%.1f' y2='%.1f'/>", kLeft, kWidth - kRight, axes.y(value),
                 axes.y(value));
    svg += print("<text class='tick' x='%.0f' y='%.1f' text-anchor='end'>%g%s</text>", kLeft - 6, axes.y(value) + 4,
                 value, share == 1.0 && cut ? "+" : "");
  }
  return svg;
}

std::string time_axis(const Axes& axes) {
  std::string svg;
  const double step = round_step(axes.duration_s);
  const double y = axes.top + kChartHeight + 16;
  for (int tick = 0; tick * step <= axes.duration_s; ++tick)
    svg += print("<text class='tick' x='%.1f' y='%.1f' text-anchor='middle'>%g%s</text>", axes.x(tick * step), y,
                 tick * step, tick == 0 ? " s" : "");
  return svg;
}

/// One of the two projections of the probe's way.
struct Projection {
  const char* title;
  const char* left_side;  ///< what is seen at the drawing's left
  glm::dvec3 right;       ///< patient direction that runs to the right
  glm::dvec3 up;
};

constexpr double kPathSize = 300;
constexpr double kPathMargin = 24;

std::string projected_path(const Projection& projection, double left, const ExamResult& result,
                           std::span<const TracePoint> trace, double mm_across, const glm::dvec3& middle) {
  const double scale = (kPathSize - 2 * kPathMargin) / mm_across;
  const auto x = [&](const glm::dvec3& p) {
    return left + kPathSize / 2 + scale * glm::dot(p - middle, projection.right);
  };
  const auto y = [&](const glm::dvec3& p) {
    return kTop + kPathSize / 2 - scale * glm::dot(p - middle, projection.up);
  };

  std::string svg =
      print("<rect class='frame' x='%.0f' y='%.0f' width='%.0f' height='%.0f'/>", left, kTop, kPathSize, kPathSize);
  svg += print("<text class='name' x='%.0f' y='%.0f'>%s</text>", left, kTop - 8, projection.title);
  svg +=
      print("<text class='tick' x='%.0f' y='%.0f'>%s</text>", left + 6, kTop + kPathSize / 2 + 4, projection.left_side);
  for (std::size_t step = 0; step < result.steps.size(); ++step) {
    std::string path;
    bool drawing = false;
    for (const TracePoint& point : trace) {
      if (point.step != step) continue;
      if (point.valid) path += print("%c%.1f %.1f", drawing ? 'L' : 'M', x(point.face), y(point.face));
      drawing = point.valid;
    }
    svg += print("<path class='way way%d' d='", int(step % 4)) + path + "'/>";
  }
  const auto first = std::find_if(trace.begin(), trace.end(), [](const TracePoint& p) { return p.valid; });
  if (first != trace.end())
    svg += print("<circle class='start' cx='%.1f' cy='%.1f' r='4'/><text class='tick' x='%.1f' y='%.1f'>start</text>",
                 x(first->face), y(first->face), x(first->face) + 7, y(first->face) - 5);
  for (const StepResult& step : result.steps) {
    if (!step.judged_to_s) continue;
    const auto judged = std::find_if(trace.begin(), trace.end(),
                                     [&](const TracePoint& p) { return p.valid && p.time_s >= *step.judged_from_s; });
    if (judged != trace.end())
      svg += print("<circle class='%s' cx='%.1f' cy='%.1f' r='5'/>",
                   step.outcome == StepOutcome::held ? "spot good" : "spot bad", x(judged->face), y(judged->face));
  }
  const double ruler_mm = round_step(mm_across * 1.5);
  svg += print("<line class='ruler' x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>", left + 10, left + 10 + ruler_mm * scale,
               kTop + kPathSize - 12, kTop + kPathSize - 12);
  svg += print("<text class='tick' x='%.1f' y='%.1f'>%g mm</text>", left + 10, kTop + kPathSize - 18, ruler_mm);
  return svg;
}

}  // namespace

std::string time_charts_svg(const ExamResult& result, std::span<const TracePoint> trace) {
  if (trace.empty()) return "";
  double fastest = 0;
  for (const TracePoint& point : trace)
    if (point.valid) fastest = std::max(fastest, point.speed_mm_s);
  const std::array quantities{Quantity{"Distance of the target from the plane, mm", 40, Metric::plane_distance_mm,
                                       [](const TracePoint& p) { return std::abs(p.view.plane_distance_mm); }},
                              Quantity{"Angle between the planes, degrees", 90, Metric::plane_angle_deg,
                                       [](const TracePoint& p) { return p.view.plane_angle_deg; }},
                              Quantity{"Target reached by the sound, %", 120, Metric::target_insonated_percent,
                                       [](const TracePoint& p) { return p.view.target_insonated_percent; }},
                              Quantity{"Speed of the probe, mm/s", 100 * std::max(1.0, std::ceil(fastest / 100)),
                                       std::nullopt, [](const TracePoint& p) { return p.speed_mm_s; }}};

  const double height = kTop + quantities.size() * (kChartHeight + kChartGap) - kChartGap + kAxisHeight;
  std::string svg = print("<svg class='chart' viewBox='0 0 %.0f %.0f' role='img'>", kWidth, height);
  Axes axes{kTop, std::max(1.0, result.motion.time_s), 1};
  for (const Quantity& quantity : quantities) {
    axes.most = quantity.most;
    svg += steps_on(axes, result, quantity.mark) + untracked(axes, trace) + scale(quantity, axes, trace) +
           curve(quantity, axes, trace);
    axes.top += kChartHeight + kChartGap;
  }
  axes.top -= kChartHeight + kChartGap;
  return svg + time_axis(axes) + "</svg>";
}

std::string path_charts_svg(const ExamResult& result, std::span<const TracePoint> trace) {
  glm::dvec3 least(1e9);
  glm::dvec3 most(-1e9);
  for (const TracePoint& point : trace) {
    if (!point.valid) continue;
    for (int c = 0; c < 3; ++c) {
      least[c] = std::min(least[c], point.face[c]);
      most[c] = std::max(most[c], point.face[c]);
    }
  }
  if (!(most.x >= least.x)) return "";
  const glm::dvec3 middle = (least + most) / 2.0;
  const double across = std::max({most.x - least.x, most.y - least.y, most.z - least.z, 20.0});
  // LPS: +x to the patient's left, which is at the right of both drawings, as on a CT.
  const Projection front{"From the front", "R", {1, 0, 0}, {0, 0, 1}};
  const Projection feet{"From the feet", "R", {1, 0, 0}, {0, -1, 0}};
  std::string svg = print("<svg class='chart' viewBox='0 0 %.0f %.0f' role='img'>", kWidth, kTop + kPathSize + 10);
  svg += projected_path(front, kLeft, result, trace, across, middle);
  svg += projected_path(feet, kLeft + kPathSize + 60, result, trace, across, middle);
  return svg + "</svg>";
}

}  // namespace insonate
