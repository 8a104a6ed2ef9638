#include "sim/model/display_filter.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace insonate {

int filter_radius_px(const Settings& settings, double mm_per_pixel) {
  const double radius = std::ceil(kFilterCut * filter_sigma_mm(settings) / mm_per_pixel);
  return int(std::min(radius, double(std::max(settings.image_width, settings.image_height) - 1)));
}

double speckle_variance(const Settings& settings, int looks) {
  double variance = glm::pi<double>() * glm::pi<double>() / 6;  // of the natural logarithm
  for (int k = 1; k < looks; ++k) variance -= 1.0 / (k * k);
  const double decibels = (settings.waves ? 10 : 5) / std::log(10.0);
  return variance * std::pow(decibels / settings.dynamic_range_db, 2);
}

}  // namespace insonate
