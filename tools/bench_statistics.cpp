#include "tools/bench_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace insonate::bench {

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const double position = share * double(values.size() - 1);
    const std::size_t below = std::size_t(position), above = std::min(below + 1, values.size() - 1);
    return values[below] + (position - double(below)) * (values[above] - values[below]);
  };
  return {at(0.25), at(0.5), at(0.75)};
}

double RootMeanSquare::value() const {
  return count_ ? std::sqrt(squares_ / double(count_)) : 0;
}

std::vector<bool> on_front(const std::vector<Cost>& costs) {
  std::vector<bool> on(costs.size());
  for (std::size_t i = 0; i < costs.size(); ++i)
    on[i] = std::none_of(costs.begin(), costs.end(), [&](const Cost& other) {
      return other.time <= costs[i].time && other.error <= costs[i].error &&
             (other.time < costs[i].time || other.error < costs[i].error);
    });
  return on;
}

}  // namespace insonate::bench
