#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "devices/recording.h"
#include "devices/sequence/probe_samples.h"
#include "sim/core/pose_sample.h"

namespace insonate {

/// What can be said of a recorded run's integrity before anybody scores it.
struct LogReport {
  /// Time between two samples in which others must have been lost.
  struct Gap {
    std::size_t frame;  ///< the one after it
    double time_s;      ///< of that frame
    double length_s;
    std::size_t missing;  ///< how many samples would have fitted in
  };
  /// Two usable samples, one right after the other, that no hand connects.
  struct Jump {
    std::size_t frame;  ///< the one after it
    double time_s;
    double mm;
    double deg;
  };
  /// Samples of one status that is not ok.
  struct Dropout {
    std::size_t frames = 0;
    std::size_t spells = 0;  ///< runs of such samples
    double longest_s = 0;    ///< from the first sample of a spell to the next sample of another status
  };

  std::size_t frames = 0;
  std::size_t usable = 0;
  double begin_s = 0;
  double duration_s = 0;  ///< from the first sample to the last
  double interval_s = 0;  ///< median of the steps between samples; 0 for a single sample
  double jitter_s = 0;    ///< RMS difference from it, of the steps that are no gaps
  double longest_step_s = 0;
  double path_mm = 0;  ///< of the probe's face between neighbouring usable samples
  std::vector<Gap> gaps;
  std::vector<Jump> jumps;
  std::map<PoseStatus, Dropout> dropouts;
  std::vector<double> marks_s;  ///< times at which the button that marks was pressed
  std::string transform;        ///< the one taken for the probe's; empty if only samples were checked
  RecordingRepairs repairs;
  bool has_times = true;  ///< false: all that depends on times is 0 or empty

  double rate_hz() const { return interval_s > 0 ? 1 / interval_s : 0; }

  /// What somebody should look at before the run is scored, a sentence each: samples that are missing, jumps, and
  /// dropouts that made the picture stand still (PoseHistory::kStaleS). A short dropout is no finding: every tracker
  /// has some.
  std::vector<std::string> findings() const;
};

/// Steps of more than this many median intervals are gaps: the next sample was due at one.
inline constexpr double kGapIntervals = 1.8;
/// A hand that scans stays below 1 m/s and a turn a second; three times that, and more than noise, is a jump.
inline constexpr double kJumpMmPerS = 3000, kJumpLeastMm = 10;
inline constexpr double kJumpDegPerS = 1080, kJumpLeastDeg = 15;

/// Looks through samples with rising times, at least one.
/// @param has_times  false: the times mean nothing
LogReport check_log(const std::vector<PoseSample>& samples, bool has_times = true);

/// Looks through a recording.
LogReport check_log(const RecordedScan& scan);

}  // namespace insonate
