#include "sim/core/spread.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace insonate {

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const double place = share * double(values.size() - 1);
    const auto below = std::size_t(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return std::lerp(values[below], values[above], place - double(below));
  };
  return {at(0.25), at(0.5), at(0.75)};
}

}  // namespace insonate
