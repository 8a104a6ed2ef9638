#include "devices/igtl/sender_clock.h"

#include <algorithm>
#include <cmath>

namespace insonate::igtl {

double SenderClock::time_of(double sent_s, double arrival_s) {
  const double difference_s = arrival_s - sent_s;
  const bool set = !offset_s_ || std::abs(difference_s - *offset_s_) > most_drift_s_;
  if (set || difference_s < *offset_s_ - tolerance_s_) {
    offset_s_ = difference_s;
    least_s_ = std::numeric_limits<double>::infinity();
    window_end_s_ = arrival_s + kWindow_s;
  }
  least_s_ = std::min(least_s_, difference_s);
  if (arrival_s >= window_end_s_) {
    if (least_s_ > *offset_s_ + tolerance_s_) offset_s_ = least_s_;
    least_s_ = std::numeric_limits<double>::infinity();
    window_end_s_ = arrival_s + kWindow_s;
  }
  return sent_s + *offset_s_;
}

}  // namespace insonate::igtl
