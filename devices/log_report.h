#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "devices/recording.h"
#include "devices/sequence/probe_samples.h"
#include "sim/core/probe_sample.h"

namespace insonate {

/// Reports on the integrity of a recorded run before it is scored.
struct LogReport {
  /// An interval between two samples in which other samples must have been lost.
  struct Gap {
    std::size_t frame;  ///< the frame after the gap
    double time_s;      ///< time of that frame
    double length_s;
    std::size_t missing;  ///< number of samples that would have fitted in
  };
  /// Two consecutive usable samples that are too far apart for a moving hand.
  struct Jump {
    std::size_t frame;  ///< the frame after the jump
    double time_s;
    double mm;
    double deg;
  };
  /// Samples of one status other than ok.
  struct Dropout {
    std::size_t frames = 0;
    std::size_t spells = 0;  ///< runs of consecutive such samples
    double longest_s = 0;    ///< from the first sample of a run to the next sample of another status
  };

  std::size_t frames = 0;
  std::size_t usable = 0;
  double begin_s = 0;
  double duration_s = 0;  ///< from the first sample to the last
  double interval_s = 0;  ///< median step between samples; 0 for a single sample
  double jitter_s = 0;    ///< RMS deviation of the steps from `interval_s`, without gaps
  double longest_step_s = 0;
  double path_mm = 0;  ///< length of the path of the probe's face, between neighbouring usable samples
  std::vector<Gap> gaps;
  std::vector<Jump> jumps;
  std::map<PoseStatus, Dropout> dropouts;
  std::vector<double> marks_s;  ///< times at which the event marker's button was pressed
  std::string transform;        ///< transform that was taken for the probe's; empty if only samples were checked
  RecordingRepairs repairs;
  bool has_times = true;  ///< false: everything that depends on times is 0 or empty

  double rate_hz() const { return interval_s > 0 ? 1 / interval_s : 0; }

  /// Returns what a person should check before the run is scored, one sentence each: missing samples, jumps, and
  /// dropouts that froze the picture (longer than PoseHistory::kStale_s). A short dropout is not a finding: every
  /// tracker has some.
  std::vector<std::string> findings() const;
};

/// A step longer than this many median intervals is a gap: the next sample was expected after one.
inline constexpr double kGapIntervals = 1.8;
/// A scanning hand stays below 1 m/s and 360 degrees per second. Three times that, and more than noise, is a jump.
inline constexpr double kJumpMmPerS = 3000, kJumpMin_mm = 10;
inline constexpr double kJumpDegPerS = 1080, kJumpMin_deg = 15;

/// Checks samples with rising times. Without samples the report is empty.
/// @param has_times  false if the times mean nothing
LogReport check_log(const std::vector<ProbeSample>& samples, bool has_times = true);

/// Checks a recording.
LogReport check_log(const RecordedScan& scan);

}  // namespace insonate
