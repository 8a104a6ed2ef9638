#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <optional>

#include "sim/core/pose_sample.h"

namespace insonate {

/// A low pass that follows closely while the probe moves and calms it while it rests: its cut-off frequency rises with
/// the speed (Casiez, Roussel and Vogel, CHI 2012).
///
/// The speed is taken from the filter's own last output to the new sample, as the reference implementations do, and is
/// itself smoothed at a fixed frequency. Translation and rotation have a cut-off each.
///
/// With 0.10 mm of noise on each axis the defaults leave 0.031 mm at 60 Hz and 0.018 mm at 240 Hz of a probe that
/// rests, and lag a motion of 100 mm/s by 11 and 7 ms (measured: `insonate-devices bench`; the beta of 0.001 that
/// public drivers use lags 60 to 90 ms).
class OneEuroFilter {
public:
  struct Options {
    double least_hz = 1.5;           ///< cut-off at rest
    double hz_per_mm_per_s = 0.1;    ///< beta: how it rises with the speed
    double hz_per_rad_per_s = 10.0;  ///< the same of a turn, as 100 mm deep in the picture sees it
    double speed_hz = 5.0;           ///< cut-off of the speed itself
  };

  explicit OneEuroFilter(const Options& options) : options_(options) {}
  OneEuroFilter() : OneEuroFilter(Options()) {}

  /// The smoothed pose of a usable sample. A sample more than kRestart_s after the last begins anew, as itself.
  Pose smooth(double time_s, const Pose& pose);

  /// Longer silences are no motion to smooth: PoseHistory does not bridge them either.
  static constexpr double kRestart_s = 0.100;

private:
  struct State {
    double time_s;
    glm::dvec3 mm, mm_per_s;
    glm::dquat turn;
    glm::dvec3 rad_per_s;
  };

  Options options_;
  std::optional<State> state_;
};

}  // namespace insonate
