#include "tools/bench/tables/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace insonate::bench {

double RootMeanSquare::value() const {
  return count_ ? std::sqrt(squares_ / double(count_)) : 0;
}

std::vector<bool> on_front(const std::vector<Cost>& costs) {
  const auto faster = [](const Cost& a, const Cost& b) { return a.time.third_quartile < b.time.first_quartile; };
  const auto finer = [](const Cost& a, const Cost& b) { return a.error < (1 - kSameError) * b.error; };
  const auto alike = [&](const Cost& a, const Cost& b) {
    return !faster(a, b) && !faster(b, a) && !finer(a, b) && !finer(b, a);
  };
  const auto beats = [&](const Cost& a, const Cost& b) {
    if (a.memory > b.memory) return false;
    return alike(a, b) ? a.memory < b.memory : a.time.median <= b.time.median && !finer(b, a);
  };
  std::vector<bool> on(costs.size());
  for (std::size_t i = 0; i < costs.size(); ++i) {
    on[i] = std::none_of(costs.begin(), costs.end(), [&](const Cost& other) { return beats(other, costs[i]); });
    for (std::size_t j = 0; j < i; ++j)
      if (on[j] && alike(costs[j], costs[i]) && costs[j].memory == costs[i].memory) on[i] = false;
  }
  return on;
}

}  // namespace insonate::bench
