#include "sim/model/display_filter.h"

#include <algorithm>
#include <cmath>

namespace insonate {

int filter_radius_px(const Settings& settings, double mm_per_pixel) {
  const double radius = std::ceil(kFilterCut * filter_sigma_mm(settings) / mm_per_pixel);
  return int(std::min(radius, double(std::max(settings.image_width, settings.image_height) - 1)));
}

double speckle_variance(const Settings& settings, int looks) {
  const double deviation_db = settings.waves ? 5.57 : 5.57 / 2;
  return std::pow(deviation_db / settings.dynamic_range_db, 2) / looks;
}

}  // namespace insonate
