#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <optional>

#include "sim/core/probe_sample.h"

namespace insonate {

/// A low-pass filter that follows a moving probe closely and smooths a resting one: its cut-off frequency rises with
/// the speed (Casiez, Roussel and Vogel, CHI 2012).
///
/// The speed is measured from the filter's own last output to the new sample, as in the reference implementations, and
/// is itself smoothed at a fixed frequency. Translation and rotation each have their own cut-off.
///
/// With 0.10 mm of noise on each axis, the defaults leave 0.031 mm at 60 Hz and 0.018 mm at 240 Hz for a resting probe.
/// They lag a motion of 100 mm/s by 11 and 7 ms (measured: `insonate-devices bench`). The beta of 0.001 that public
/// drivers use lags by 60 to 90 ms.
class OneEuroFilter {
public:
  struct Options {
    double least_hz = 1.5;           ///< cut-off at rest
    double hz_per_mm_per_s = 0.1;    ///< beta: how the cut-off rises with the speed
    double hz_per_rad_per_s = 10.0;  ///< the same for a rotation, by the motion it causes 100 mm deep in the picture
    double speed_hz = 5.0;           ///< cut-off of the speed itself
  };

  explicit OneEuroFilter(const Options& options) : options_(options) {}
  OneEuroFilter() : OneEuroFilter(Options()) {}

  /// Returns the smoothed pose of a usable sample. A sample that comes more than kRestart_s after the last one restarts
  /// the filter and is returned unchanged.
  Pose smooth(double time_s, const Pose& pose);

  /// Longer gaps are not smoothed over; PoseHistory does not interpolate across them either.
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
