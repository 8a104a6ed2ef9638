#pragma once

#include <vector>

namespace insonate::bench {

/// What is told of repeated measurements: half of them lie between the quartiles.
struct Spread {
  double first_quartile = 0, median = 0, third_quartile = 0;
};

/// Quantiles at the ends and evenly between, linear between neighbours. Of no values: zeros.
Spread spread_of(std::vector<double> values);

/// The root of the mean square of what is added.
class RootMeanSquare {
public:
  void add(double value) {
    squares_ += value * value;
    ++count_;
  }
  /// 0 when nothing was added.
  double value() const;
  long count() const { return count_; }

private:
  double squares_ = 0;
  long count_ = 0;
};

/// A setting's run time and error, and the memory that it takes of the device.
struct Cost {
  Spread time;
  double error = 0;
  double memory = 0;
};

/// Errors that differ by less than this share show no difference.
inline constexpr double kSameError = 0.01;

/// For each, whether it lies on the front: no other that takes no more memory is better in time or error and at least
/// as good in the other. Times whose quartiles overlap and errors within kSameError are no better than each other; of
/// settings that are so alike in both, and take as much memory, the first lies on the front for all.
std::vector<bool> on_front(const std::vector<Cost>& costs);

}  // namespace insonate::bench
