#include "tools/bench/tables/curves.h"

#include <algorithm>
#include <cmath>

#include "sim/core/text.h"
#include "tools/bench/tables/svg.h"

namespace insonate::bench {
namespace {

// All lengths are in the drawing's own units, which are pixels on a screen.
constexpr double kPlotWidth = 360, kPlotHeight = 300, kHead = 30;
constexpr double kLeft = 44, kRight = 12, kTop = 42, kBottom = 46, kLegendLine = 16, kEnd = 12;

// Returns the distance of grid lines: 1, 2 or 5 times a power of ten, with at most 8 of them up to `most`.
double grid_step(double most) {
  const double decade = std::pow(10, std::floor(std::log10(most / 8)));
  for (const double step : {1.0, 2.0, 5.0})
    if (most / (decade * step) <= 8) return decade * step;
  return 10 * decade;
}

std::string drawn(const CurvePlot& plot, double left, double top) {
  double most_x = 0, most_y = 0;
  for (const Curve& curve : plot.curves)
    for (const auto& [x, y] : curve.points) {
      most_x = std::max(most_x, x);
      most_y = std::max(most_y, 1.05 * y);
    }
  if (most_x <= 0 || most_y <= 0) return "";
  const double from_x = left + kLeft, to_x = left + kPlotWidth - kRight;
  const double from_y = top + kPlotHeight - kBottom, to_y = top + kTop;
  const auto at_x = [&](double x) { return from_x + (to_x - from_x) * x / most_x; };
  const auto at_y = [&](double y) { return from_y + (to_y - from_y) * y / most_y; };

  std::string svg =
      formatted("<text class='name' x='%.0f' y='%.0f'>", from_x, top + 14) + escaped(plot.title) + "</text>\n";
  for (double x = 0; x <= most_x * 1.0001; x += grid_step(most_x))
    svg += formatted(
        "<line class='grid' x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>"
        "<text class='quiet' x='%.1f' y='%.1f' text-anchor='middle'>%g</text>\n",
        at_x(x), at_x(x), from_y, to_y, at_x(x), from_y + 16, x);
  for (double y = 0; y <= most_y; y += grid_step(most_y))
    svg += formatted(
        "<line class='grid' x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>"
        "<text class='quiet' x='%.1f' y='%.1f' text-anchor='end'>%g</text>\n",
        from_x, to_x, at_y(y), at_y(y), from_x - 6, at_y(y) + 4, y);
  svg +=
      formatted("<text x='%.0f' y='%.0f' text-anchor='end'>", to_x, from_y + 34) + escaped(plot.x_name) + "</text>\n";
  svg += formatted("<text x='%.0f' y='%.0f'>", left + 8, to_y - 8) + escaped(plot.y_name) + "</text>\n";
  double legend = top + kPlotHeight;  // below the plot
  for (const Curve& curve : plot.curves) {
    const char* dashes = curve.dashed ? "5 3" : "none";
    std::string line;
    for (const auto& [x, y] : curve.points) line += formatted("%.1f,%.1f ", at_x(x), at_y(y));
    svg += formatted("<polyline fill='none' stroke='%s' stroke-width='1.5' stroke-dasharray='%s' points='",
                     curve.colour.c_str(), dashes) +
           line + "'/>\n";
    svg += formatted(
               "<line stroke='%s' stroke-width='1.5' stroke-dasharray='%s' x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>",
               curve.colour.c_str(), dashes, from_x + 8, from_x + 30, legend, legend) +
           formatted("<text x='%.1f' y='%.1f'>", from_x + 36, legend + 4) + escaped(curve.name) + "</text>\n";
    legend += kLegendLine;
  }
  return svg;
}

}  // namespace

std::string curves_svg(const std::string& head, const std::vector<CurvePlot>& plots) {
  std::size_t names = 0;
  for (const CurvePlot& plot : plots) names = std::max(names, plot.curves.size());
  const double width = kPlotWidth * double(plots.size());
  const double height = kHead + kPlotHeight + kLegendLine * double(names) + kEnd;
  std::string svg =
      formatted("<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f' viewBox='0 0 %.0f %.0f'>\n", width,
                height, width, height);
  svg += std::string("<style>") + kPlotStyle + "</style>\n<rect width='100%' height='100%' fill='#fff'/>\n";
  svg += formatted("<text class='quiet' x='%.0f' y='20'>", kLeft) + escaped(head) + "</text>\n";
  for (std::size_t i = 0; i < plots.size(); ++i) svg += drawn(plots[i], kPlotWidth * double(i), kHead);
  return svg + "</svg>\n";
}

}  // namespace insonate::bench
