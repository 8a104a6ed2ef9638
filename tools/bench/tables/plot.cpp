#include "tools/bench/tables/plot.h"

#include <algorithm>
#include <cmath>

#include "sim/core/text.h"
#include "tools/bench/tables/svg.h"

namespace insonate::bench {
namespace {

// All lengths are in the drawing's own units, which are pixels on a screen.
constexpr double kWidth = 880, kPanelHeight = 400;
constexpr double kLeft = 60, kRight = 320, kTop = 42, kBottom = 46;
constexpr double kHead = 30;
constexpr double kLegend = kWidth - kRight + 16, kLegendLine = 16;

constexpr char kStyle[] =
    "circle{fill:#b4bec9}circle.best{fill:#2567a8}circle.standard{stroke:#b3362b;stroke-width:2.5}"
    ".label{font-size:10px}.label tspan{font-weight:600}";

/// Maps values to positions, logarithmically, with a margin at both ends.
struct Axis {
  double low = 1, high = 10, from = 0, to = 1;

  Axis(const std::vector<double>& values, double start, double end) : from(start), to(end) {
    if (values.empty()) return;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    low = *least / 1.15;
    high = *most * 1.15;
  }
  double at(double value) const { return from + (to - from) * std::log(value / low) / std::log(high / low); }
  /// 1, 2 and 5 of every decade.
  std::vector<double> ticks() const {
    std::vector<double> found;
    for (double decade = std::pow(10, std::floor(std::log10(low))); decade <= high; decade *= 10)
      for (const double step : {1.0, 2.0, 5.0})
        if (decade * step >= low && decade * step <= high) found.push_back(decade * step);
    return found;
  }
};

std::string drawn(const Panel& panel, double top) {
  std::vector<Point> points;
  std::copy_if(panel.points.begin(), panel.points.end(), std::back_inserter(points),
               [](const Point& p) { return p.time_ms > 0 && p.error_db > 0; });
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.time_ms < b.time_ms; });
  std::vector<double> times, errors;
  for (const Point& p : points) {
    times.push_back(p.time_ms);
    errors.push_back(p.error_db);
  }
  const double bottom = top + kPanelHeight - kBottom;
  const Axis x(times, kLeft, kWidth - kRight), y(errors, bottom, top + kTop);

  std::string svg =
      formatted("<text class='name' x='%.0f' y='%.0f'>", kLeft, top + 14) + escaped(panel.title) + "</text>\n";
  for (const double tick : x.ticks())
    svg += formatted(
        "<line class='grid' x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>"
        "<text class='quiet' x='%.1f' y='%.1f' text-anchor='middle'>%g</text>\n",
        x.at(tick), x.at(tick), top + kTop, bottom, x.at(tick), bottom + 16, tick);
  for (const double tick : y.ticks())
    svg += formatted(
        "<line class='grid' x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>"
        "<text class='quiet' x='%.1f' y='%.1f' text-anchor='end'>%g</text>\n",
        kLeft, kWidth - kRight, y.at(tick), y.at(tick), kLeft - 6, y.at(tick) + 4, tick);
  svg += formatted("<text x='%.0f' y='%.0f' text-anchor='end'>frame with a moving probe, ms</text>\n", kWidth - kRight,
                   bottom + 34);
  svg += formatted("<text x='8' y='%.0f'>RMS error, dB</text>\n", top + kTop - 8);

  std::string front;
  for (const Point& p : points)
    if (p.on_front) front += formatted("%.1f,%.1f ", x.at(p.time_ms), y.at(p.error_db));
  svg += "<polyline class='front' points='" + front + "'/>\n";
  int named = 0;
  for (const Point& p : points) {
    svg += formatted("<circle class='%s%s' cx='%.1f' cy='%.1f' r='4'><title>", p.on_front ? "best" : "",
                     p.quality.empty() ? "" : " standard", x.at(p.time_ms), y.at(p.error_db)) +
           escaped(p.name) + formatted(": %.2f ms, %.3f dB</title></circle>\n", p.time_ms, p.error_db);
    if (!p.on_front && p.quality.empty()) continue;
    // The point shows a number at its lower left, where no other setting lies. The list beside the panel explains it.
    ++named;
    svg += formatted(
               "<text class='label' x='%.1f' y='%.1f' text-anchor='end'>%d</text>"
               "<text class='label' x='%.0f' y='%.1f'><tspan>%d</tspan>  ",
               x.at(p.time_ms) - 5, y.at(p.error_db) + 11, named, kLegend, top + kTop + kLegendLine * named, named) +
           escaped(p.name + (p.quality.empty() ? "" : " (" + p.quality + ")")) +
           formatted(": %.1f ms, %.2f dB</text>\n", p.time_ms, p.error_db);
  }
  return svg;
}

}  // namespace

std::string front_svg(const std::string& device, const std::vector<Panel>& panels) {
  const double height = kHead + kPanelHeight * double(panels.size());
  std::string svg =
      formatted("<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f' viewBox='0 0 %.0f %.0f'>\n", kWidth,
                height, kWidth, height);
  svg += std::string("<style>") + kPlotStyle + kStyle + "</style>\n<rect width='100%' height='100%' fill='#fff'/>\n";
  svg += formatted("<text class='quiet' x='%.0f' y='20'>", kLeft) + escaped(device) + "</text>\n";
  for (std::size_t i = 0; i < panels.size(); ++i) svg += drawn(panels[i], kHead + kPanelHeight * double(i));
  return svg + "</svg>\n";
}

}  // namespace insonate::bench
