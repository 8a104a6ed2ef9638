#include "app/pictures/ct_look.h"

#include <algorithm>
#include <cmath>

namespace insonate {

WindowLevel dragged(const WindowLevel& from, const glm::dvec2& by) {
  // 400 pixels across double a window; narrow ones change by one unit per pixel.
  const double unit = std::max(1.0, from.window_hu / 400);
  return {std::clamp(std::round(from.window_hu + unit * by.x), WindowLevel::kMinWindow, WindowLevel::kMaxWindow),
          std::clamp(std::round(from.level_hu - unit * by.y), WindowLevel::kMinLevel, WindowLevel::kMaxLevel)};
}

}  // namespace insonate
