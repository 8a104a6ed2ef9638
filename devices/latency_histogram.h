#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace insonate {

/// How long it takes from a tracker's report to what is made of it, counted in steps of a millisecond.
class LatencyHistogram {
public:
  static constexpr double kStep_s = 0.001;
  /// The last step holds everything above.
  static constexpr std::size_t kSteps = 200;

  void add(double seconds);

  std::uint64_t count() const { return count_; }
  /// The time that a share of all stays below, at the step's upper end; 0 of none.
  double quantile_s(double share) const;
  const std::array<std::uint64_t, kSteps>& counts() const { return counts_; }

  /// "median 6 ms, 95 % below 14 ms, 99 % below 19 ms, of 600 frames", and a bar for each step in use.
  std::string text() const;

private:
  std::array<std::uint64_t, kSteps> counts_{};
  std::uint64_t count_ = 0;
};

/// Histograms side by side as CSV: a line for each millisecond up to the last one in use, a column for each histogram.
/// `names` are as many as there are histograms.
std::string to_csv(const std::vector<std::string>& names, const std::vector<LatencyHistogram>& histograms);

}  // namespace insonate
