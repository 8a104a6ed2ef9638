#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace insonate {

/// Histogram of the latency from a tracker's report to the result made from it, in bins of 1 ms.
class LatencyHistogram {
public:
  static constexpr double kStep_s = 0.001;
  /// The last bin holds everything above it.
  static constexpr std::size_t kSteps = 200;

  void add(double seconds);

  std::uint64_t count() const { return count_; }
  /// Returns the latency below which `share` (0 to 1) of all values lie, rounded up to the end of the bin. Returns 0 if
  /// the histogram is empty.
  double quantile_s(double share) const;
  const std::array<std::uint64_t, kSteps>& counts() const { return counts_; }

  /// Returns "median 6 ms, 95 % below 14 ms, 99 % below 19 ms, of 600 frames", and one bar per bin in use.
  std::string text() const;

private:
  std::array<std::uint64_t, kSteps> counts_{};
  std::uint64_t count_ = 0;
};

/// Returns histograms side by side as CSV: one row per millisecond up to the last one in use, one column per histogram.
/// `names` has as many entries as `histograms`.
std::string to_csv(const std::vector<std::string>& names, const std::vector<LatencyHistogram>& histograms);

}  // namespace insonate
