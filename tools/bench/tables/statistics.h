#pragma once

#include <vector>

#include "sim/core/spread.h"

namespace insonate::bench {

/// Accumulates a root mean square.
class RootMeanSquare {
public:
  void add(double value) {
    squares_ += value * value;
    ++count_;
  }
  /// Returns 0 if nothing was added.
  double value() const;
  long count() const { return count_; }

private:
  double squares_ = 0;
  long count_ = 0;
};

/// A setting's run time, error and device memory.
struct Cost {
  Spread time;
  double error = 0;
  double memory = 0;
};

/// Errors that differ by a smaller share count as equal.
inline constexpr double kSameError = 0.01;

/// Returns for each setting whether it lies on the front. A setting is on the front if no other setting with at most as
/// much memory is better in time or error and at least as good in the other. Times with overlapping quartiles and
/// errors within kSameError count as equal. Among settings that are equal in both and use the same memory, only the
/// first is on the front.
std::vector<bool> on_front(const std::vector<Cost>& costs);

}  // namespace insonate::bench
