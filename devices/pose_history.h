#pragma once

#include <deque>
#include <limits>
#include <string_view>

#include "sim/core/probe_sample.h"

namespace insonate {

/// How PoseHistory determined the pose at a time, from the best to the worst.
enum class PoseAnswer {
  exact,         ///< a sample has exactly this time
  interpolated,  ///< between two samples: translation linearly, rotation by slerp
  predicted,     ///< shortly after the last usable sample, by its velocity
  held,          ///< later: the pose stays where the prediction ended
  stale,         ///< still the same pose, but so old that the picture needs a warning banner
  none,          ///< no usable sample yet, or none that early
};

std::string_view to_string(PoseAnswer answer);

/// A pose returned by PoseHistory, and how it was determined.
struct PoseEstimate {
  PoseAnswer how = PoseAnswer::none;
  Pose patient_from_probe;  ///< meaningless if `how` is none
  double age_s = 0;         ///< time since the last usable sample at or before the requested time
};

/// Keeps the last 2 s of a tracker's samples and returns the pose at a time on the tracker's clock.
///
/// Samples that are not ok never move the probe. Poses are not interpolated to or from them, and the first one after
/// the last usable sample ends the prediction.
class PoseHistory {
public:
  /// Beyond this a prediction errs too much, because a hand changes direction: by 0.4 mm RMS at 20 ms, 0.6 at 30, and 2
  /// at 50 (docs/benchmarks/trackers).
  static constexpr double kPredict_s = 0.030;
  /// Longer gaps between usable samples are not interpolated.
  static constexpr double kBridge_s = 0.100;
  /// An older pose freezes the picture.
  static constexpr double kStale_s = 0.250;
  static constexpr double kKept_s = 2.0;

  /// Adds a sample. Samples come in the order of their times. A sample that is not later than the last one starts a new
  /// history.
  void add(const ProbeSample& sample);
  void clear();

  /// Returns the pose at `time_s` on the tracker's clock. After the last usable sample the pose is predicted for
  /// `predict_s`, at most kPredict_s. With 0 it stays where it was.
  PoseEstimate at(double time_s, double predict_s = kPredict_s) const;

private:
  struct Entry {
    double time_s;
    Pose pose;
    /// Time of the first sample after this one that is not ok, if it came before the next usable one; else infinity.
    double unusable_from_s = std::numeric_limits<double>::infinity();
  };

  PoseEstimate after(std::size_t index, double time_s, double predict_s) const;
  Pose predict(std::size_t index, double ahead_s) const;

  std::deque<Entry> usable_;  ///< by rising time
  double newest_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace insonate
