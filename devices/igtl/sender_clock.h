#pragma once

#include <limits>
#include <optional>

namespace insonate::igtl {

/// Brings the times that a sender stamps its messages with to our clock, without what the network adds to each.
///
/// Between the two clocks lies an offset, and a message arrives later than that by what it was held up; so the least of
/// the differences between arrival and stamp tells the offset best. It is taken from the first message and then left
/// alone, which keeps the steps between the messages as they are, until it turns out to be wrong by more than a
/// tolerance: a message comes earlier than it says, or none of five seconds came as early as it says (the first was
/// held up, or a clock drifts). A difference of more than `most_drift_s` is a clock that was set.
class SenderClock {
public:
  static constexpr double kWindowS = 5;

  explicit SenderClock(double tolerance_s = 0.010, double most_drift_s = 2.0)
      : tolerance_s_(tolerance_s), most_drift_s_(most_drift_s) {}

  /// Our time of a message with its sender's time, by arrival; arrivals do not fall from call to call. Times may, when
  /// the offset changes.
  double time_of(double sent_s, double arrival_s);

private:
  double tolerance_s_, most_drift_s_;
  std::optional<double> offset_s_;                            ///< from the sender's clock to ours
  double least_s_ = std::numeric_limits<double>::infinity();  ///< difference in the window that is under way
  double window_end_s_ = 0;
};

}  // namespace insonate::igtl
