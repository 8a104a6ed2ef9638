#include "sim/model/quality.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace insonate {
namespace {

/// Scales a number of samples or pixels.
int scaled(int count, double share) {
  constexpr int kMax = 8192;
  return std::clamp(int(std::lround(share * count)), 1, kMax);
}

}  // namespace

std::string name_of(Quality quality) {
  switch (quality) {
    case Quality::fast:
      return "fast";
    case Quality::balanced:
      return "balanced";
    case Quality::exact:
      return "exact";
  }
  throw std::invalid_argument("no quality");
}

std::vector<std::string> quality_names() {
  std::vector<std::string> names;
  for (const Quality quality : kQualities) names.push_back(name_of(quality));
  return names;
}

Quality quality_named(const std::string& name) {
  for (const Quality quality : kQualities)
    if (name == name_of(quality)) return quality;
  throw std::invalid_argument("there is no quality named '" + name + "'");
}

Settings at_quality(Settings balanced, Quality quality) {
  const double samples = quality == Quality::fast ? 0.5 : quality == Quality::exact ? 4 : 1;
  const double pixels = quality == Quality::fast ? 0.75 : 1;
  balanced.samples = scaled(balanced.samples, samples);
  balanced.image_width = scaled(balanced.image_width, pixels);
  balanced.image_height = scaled(balanced.image_height, pixels);
  return balanced;
}

}  // namespace insonate
