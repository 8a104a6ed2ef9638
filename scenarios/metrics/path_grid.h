#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/core/pose.h"

namespace insonate {

/// Rounding error of time differences: a double holds seconds since 1970 to a quarter of a microsecond. Every
/// comparison of a difference with a limit must allow for it. Otherwise the score would depend on the origin of time.
inline constexpr double kTimeRounding_s = 1e-6;

/// Resamples the probe's path at kRate_hz. It interpolates between valid samples at most kBridged_s apart. So results
/// do not depend on the tracker's sample rate.
class PathGrid {
public:
  static constexpr double kRate_hz = 20;
  static constexpr double kBridged_s = 0.25;  ///< also the time after which a picture freezes with a banner

  /// Returns true if the time between two valid samples is short enough for interpolation.
  static bool bridges(double gap_s) { return gap_s <= kBridged_s + kTimeRounding_s; }

  /// Grid pose n lies n / kRate_hz after `start_s`.
  explicit PathGrid(double start_s = 0) : start_s_(start_s) {}

  /// Returns a grid for an interval that starts at `start_s` and knows the last sample of this one.
  PathGrid following(double start_s) const {
    PathGrid next(start_s);
    next.last_ = last_;
    return next;
  }

  /// Processes a valid sample and calls `pose_at(n, pose, follows)` for each grid pose that it completes. `follows` is
  /// true if grid pose n - 1 came before.
  template <typename PoseAt>
  void feed(double time_s, const Pose& pose, PoseAt&& pose_at) {
    const double now = time_s - start_s_;
    if (!last_ || !bridges(time_s - last_->time_s)) {
      follows_ = false;
      next_ = long(std::ceil((now - kTimeRounding_s) * kRate_hz));
    }
    const double before = last_ ? last_->time_s - start_s_ : now;
    for (; double(next_) / kRate_hz <= now + kTimeRounding_s; ++next_) {
      const double share = now > before ? std::min(1.0, (double(next_) / kRate_hz - before) / (now - before)) : 1;
      pose_at(next_, last_ ? interpolate(last_->pose, pose, share) : pose, follows_);
      follows_ = true;
    }
    last_ = Sample{time_s, pose};
  }

private:
  struct Sample {
    double time_s;
    Pose pose;
  };
  double start_s_;
  long next_ = 0;
  bool follows_ = false;
  std::optional<Sample> last_;
};

}  // namespace insonate
