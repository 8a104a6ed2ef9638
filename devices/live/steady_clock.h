#pragma once

#include <chrono>

namespace insonate {

/// The one clock of everything that happens in real time (s): never runs backwards, the same on every thread, and
/// counts from the first time that anybody in the process asks. Live trackers stamp their samples with it and are
/// polled with it.
inline double steady_now_s() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace insonate
