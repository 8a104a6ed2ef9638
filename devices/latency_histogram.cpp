#include "devices/latency_histogram.h"

#include <algorithm>
#include <cstdio>

namespace insonate {
namespace {

/// Returns one more than the index of the last bin that is not empty.
std::size_t used_steps(const LatencyHistogram& histogram) {
  std::size_t used = histogram.counts().size();
  while (used > 0 && histogram.counts()[used - 1] == 0) --used;
  return used;
}

}  // namespace

void LatencyHistogram::add(double seconds) {
  const double step = std::clamp(seconds / kStep_s, 0.0, double(kSteps - 1));
  ++counts_[std::size_t(step)];
  ++count_;
}

double LatencyHistogram::quantile_s(double share) const {
  std::uint64_t below = 0;
  for (std::size_t step = 0; step < kSteps && count_ > 0; ++step) {
    below += counts_[step];
    if (double(below) >= share * double(count_)) return double(step + 1) * kStep_s;
  }
  return 0;
}

std::string LatencyHistogram::text() const {
  char line[160];
  std::snprintf(line, sizeof line, "median %.0f ms, 95 %% below %.0f ms, 99 %% below %.0f ms, of %llu frames\n",
                quantile_s(0.5) * 1e3, quantile_s(0.95) * 1e3, quantile_s(0.99) * 1e3,
                static_cast<unsigned long long>(count_));
  std::string text = line;
  const std::uint64_t most = *std::max_element(counts_.begin(), counts_.end());
  for (std::size_t step = 0; step < used_steps(*this); ++step) {
    constexpr double kBar = 50;
    std::snprintf(line, sizeof line, "  %3zu ms %7llu ", step, static_cast<unsigned long long>(counts_[step]));
    text += line + std::string(std::size_t(kBar * double(counts_[step]) / double(most)), '#') + "\n";
  }
  return text;
}

std::string to_csv(const std::vector<std::string>& names, const std::vector<LatencyHistogram>& histograms) {
  std::string csv = "from_ms";
  for (const std::string& name : names) csv += "," + name;
  csv += "\n";
  std::size_t used = 0;
  for (const LatencyHistogram& histogram : histograms) used = std::max(used, used_steps(histogram));
  for (std::size_t step = 0; step < used; ++step) {
    csv += std::to_string(step);
    for (const LatencyHistogram& histogram : histograms) csv += "," + std::to_string(histogram.counts()[step]);
    csv += "\n";
  }
  return csv;
}

}  // namespace insonate
