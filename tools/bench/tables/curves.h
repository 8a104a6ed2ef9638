#pragma once

#include <string>
#include <utility>
#include <vector>

namespace insonate::bench {

/// A line of a plot, through points from left to right.
struct Curve {
  std::string name;    ///< in the legend
  std::string colour;  ///< CSS
  bool dashed = false;
  std::vector<std::pair<double, double>> points;
};

/// One plot of several curves over the same two axes.
struct CurvePlot {
  std::string title, x_name, y_name;
  std::vector<Curve> curves;
};

/// Returns an SVG with the plots side by side. Both axes are linear and begin at 0.
std::string curves_svg(const std::string& head, const std::vector<CurvePlot>& plots);

}  // namespace insonate::bench
