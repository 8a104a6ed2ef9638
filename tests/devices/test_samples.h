#pragma once

#include <cstring>
#include <vector>

#include "sim/core/pose_sample.h"

namespace insonate {

/// Whether two samples are the same to the last bit.
inline bool same_bits(const PoseSample& a, const PoseSample& b) {
  return std::memcmp(&a.time_s, &b.time_s, sizeof a.time_s) == 0 && a.status == b.status && a.buttons == b.buttons &&
         std::memcmp(&a.patient_from_probe, &b.patient_from_probe, sizeof a.patient_from_probe) == 0;
}

inline bool same_bits(const std::vector<PoseSample>& a, const std::vector<PoseSample>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!same_bits(a[i], b[i])) return false;
  return true;
}

/// Everything a tracker gives up to `until_s`, polled `polls_per_s` times a second from 0 on.
template <typename SomeTracker>
std::vector<PoseSample> poll_until(SomeTracker& tracker, double until_s, double polls_per_s) {
  std::vector<PoseSample> samples;
  for (int i = 0; i / polls_per_s < until_s; ++i) tracker.poll(i / polls_per_s, samples);
  tracker.poll(until_s, samples);
  return samples;
}

}  // namespace insonate
