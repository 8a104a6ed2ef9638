#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/core/pose.h"

namespace insonate {

/// What differences of times may be off by rounding: a double holds seconds since 1970 to a quarter of a microsecond.
/// Whoever compares one with a limit allows for it, or the score would depend on where time begins.
inline constexpr double kTimeRounding_s = 1e-6;

/// The way of a probe at kRate_hz, interpolated between valid samples that are no further apart than kBridged_s: what
/// is made of it does not depend on how fast a tracker samples.
class PathGrid {
public:
  static constexpr double kRate_hz = 20;
  static constexpr double kBridged_s = 0.25;  ///< when a picture freezes with a banner, too

  /// Whether the time between two valid samples is short enough to know what was between them.
  static bool bridges(double gap_s) { return gap_s <= kBridged_s + kTimeRounding_s; }

  /// Grid pose n lies n / kRate_hz after `start_s`.
  explicit PathGrid(double start_s = 0) : start_s_(start_s) {}

  /// Of a stretch that begins anew at that time and knows the last sample.
  PathGrid following(double start_s) const {
    PathGrid next(start_s);
    next.last_ = last_;
    return next;
  }

  /// Takes a valid sample and calls `pose_at(n, pose, follows)` for each pose of the grid that it completes; `follows`
  /// says whether grid pose n - 1 came before.
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
