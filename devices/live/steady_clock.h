#pragma once

#include <chrono>

namespace insonate {

/// Returns the time (s) of the one clock for everything that happens in real time. It never runs backwards, is the same
/// on every thread, and starts at the process's first call. Live trackers stamp their samples with it and are polled
/// with it.
inline double steady_now_s() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace insonate
