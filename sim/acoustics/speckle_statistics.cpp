#include "sim/acoustics/speckle_statistics.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace insonate {

double envelope_snr(std::span<const double> envelope) {
  const double count = double(envelope.size());
  double mean = 0, variance = 0;
  for (const double value : envelope) mean += value / count;
  for (const double value : envelope) variance += (value - mean) * (value - mean) / count;
  return mean / std::sqrt(variance);
}

RayleighTest rayleigh_test(std::span<const double> envelope) {
  std::vector<double> powers;
  powers.reserve(envelope.size());
  for (const double value : envelope) powers.push_back(value * value);
  std::sort(powers.begin(), powers.end());
  const double count = double(powers.size());
  double mean = 0;
  for (const double power : powers) mean += power / count;

  RayleighTest test;
  for (std::size_t i = 0; i < powers.size(); ++i) {
    const double expected = 1 - std::exp(-powers[i] / mean);
    test.distance = std::max({test.distance, expected - double(i) / count, double(i + 1) / count - expected});
  }
  test.statistic = (test.distance - 0.2 / count) * (std::sqrt(count) + 0.26 + 0.5 / std::sqrt(count));
  return test;
}

}  // namespace insonate
