#pragma once

#include <string>
#include <vector>

namespace insonate::bench {

/// A setting in the plot of run time against error.
struct Point {
  std::string name;
  double time_ms = 0, error_db = 0;  ///< > 0 to be drawn
  bool on_front = false;
  std::string quality = {};  ///< the level of quality that it is, if any, which is named and ringed
  bool leaves_out = false;   ///< an effect, so that it is another picture
};

struct Panel {
  std::string title;
  std::vector<Point> points;
};

/// One panel a scene under each other, both axes logarithmic, the front joined by a line and its points named.
std::string front_svg(const std::string& device, const std::vector<Panel>& panels);

}  // namespace insonate::bench
