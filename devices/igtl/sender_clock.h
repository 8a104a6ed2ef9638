#pragma once

#include <limits>
#include <optional>

namespace insonate::igtl {

/// Converts the times with which a sender stamps its messages to our clock, without the delays that the network adds.
///
/// The two clocks differ by an offset, and each message arrives later than that by its delay. So the smallest
/// difference between arrival and stamp is the best estimate of the offset. It is taken from the first message and then
/// kept, which preserves the steps between messages. It changes only if it proves wrong by more than a tolerance: if a
/// message arrives earlier than the offset allows, or if for 5 s no message arrived as early as it predicts (the first
/// was delayed, or a clock drifts). A difference of more than `most_drift_s` means that a clock was set.
class SenderClock {
public:
  static constexpr double kWindow_s = 5;

  explicit SenderClock(double tolerance_s = 0.010, double most_drift_s = 2.0)
      : tolerance_s_(tolerance_s), most_drift_s_(most_drift_s) {}

  /// Returns our time for a message with the sender's time `sent_s`. Arrivals do not fall from call to call. The
  /// returned times may fall when the offset changes.
  double time_of(double sent_s, double arrival_s);

private:
  double tolerance_s_, most_drift_s_;
  std::optional<double> offset_s_;                            ///< from the sender's clock to ours
  double least_s_ = std::numeric_limits<double>::infinity();  ///< smallest difference in the current window
  double window_end_s_ = 0;
};

}  // namespace insonate::igtl
