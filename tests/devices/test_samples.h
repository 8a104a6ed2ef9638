#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "sim/core/probe_sample.h"

namespace insonate {

inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// Returns whether two samples are bit-identical.
inline bool same_bits(const ProbeSample& a, const ProbeSample& b) {
  if (!same_bits(a.time_s, b.time_s) || a.status != b.status || a.buttons != b.buttons ||
      a.distortion != b.distortion || a.rejected != b.rejected)
    return false;
  const glm::dmat4 x = a.patient_from_probe.matrix(), y = b.patient_from_probe.matrix();
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!same_bits(x[column][row], y[column][row])) return false;
  return true;
}

inline bool same_bits(const std::vector<ProbeSample>& a, const std::vector<ProbeSample>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!same_bits(a[i], b[i])) return false;
  return true;
}

/// Returns all samples of a tracker up to `until_s`, polled `polls_per_s` times per second from 0 on.
template <typename SomeTracker>
std::vector<ProbeSample> poll_until(SomeTracker& tracker, double until_s, double polls_per_s) {
  std::vector<ProbeSample> samples;
  for (int i = 0; i / polls_per_s < until_s; ++i) tracker.poll(i / polls_per_s, samples);
  tracker.poll(until_s, samples);
  return samples;
}

}  // namespace insonate
