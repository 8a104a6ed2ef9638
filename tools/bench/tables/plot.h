#pragma once

#include <string>
#include <vector>

namespace insonate::bench {

/// One setting in the plot of run time against error.
struct Point {
  std::string name;
  double time_ms = 0, error_db = 0;  ///< drawn only if both are > 0
  bool on_front = false;
  std::string quality = {};  ///< name of its level of quality, if it is one; shown with a ring
  bool leaves_out = false;   ///< leaves out an effect, so that its picture is not comparable
};

/// The settings of one scene.
struct Panel {
  std::string title;
  std::vector<Point> points;
};

/// Returns an SVG with one panel per scene, stacked. Both axes are logarithmic. A line joins the points of the front,
/// which are labelled.
std::string front_svg(const std::string& device, const std::vector<Panel>& panels);

}  // namespace insonate::bench
