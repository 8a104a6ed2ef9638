#pragma once

#include <deque>
#include <limits>
#include <string_view>

#include "sim/core/pose_sample.h"

namespace insonate {

/// How a question for the probe's pose at a time was answered, from the best to the worst.
enum class PoseAnswer {
  exact,         ///< a sample has just this time
  interpolated,  ///< between two samples: translation straight, rotation by slerp
  predicted,     ///< a little after the last usable sample, by its velocity
  held,          ///< later: the pose stays where the prediction ended
  stale,         ///< still the same pose, but so old that the picture needs a banner
  none,          ///< no usable sample yet, or none so early
};

std::string_view to_string(PoseAnswer answer);

struct PoseEstimate {
  PoseAnswer how = PoseAnswer::none;
  Pose patient_from_probe;  ///< meaningless when how is none
  double age_s = 0;         ///< since the last usable sample at or before that time
};

/// The last two seconds of a tracker's samples, asked for the pose at a time on the tracker's clock.
///
/// Samples that are not ok never move the probe: they are no ends to interpolate between, and the first one after the
/// last usable sample ends the prediction.
class PoseHistory {
public:
  /// Beyond that a prediction is worse than none: a hand changes its mind (DEVICES: 0.26 mm RMS at 20 ms, 0.76 at 50).
  static constexpr double kPredictS = 0.030;
  /// Longer gaps between usable samples are not bridged by a straight line.
  static constexpr double kBridgeS = 0.100;
  static constexpr double kStaleS = 0.250;
  static constexpr double kKeptS = 2.0;

  /// Samples come in the order of their times; one that is not after the last begins a new history.
  void add(const PoseSample& sample);
  void clear();

  /// The pose at a time on the tracker's clock. Behind the last usable sample it is predicted for `predict_s`, which
  /// counts up to kPredictS; 0 leaves it where it was.
  PoseEstimate at(double time_s, double predict_s = kPredictS) const;

private:
  struct Entry {
    double time_s;
    Pose pose;
    /// Time of the first sample after this one that is not ok, if it came before the next usable one.
    double unusable_from_s = std::numeric_limits<double>::infinity();
  };

  PoseEstimate after(std::size_t index, double time_s, double predict_s) const;
  Pose predict(std::size_t index, double ahead_s) const;

  std::deque<Entry> usable_;  ///< by rising time
  double newest_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace insonate
