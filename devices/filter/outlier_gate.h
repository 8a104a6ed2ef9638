#pragma once

#include <glm/vec3.hpp>

#include <optional>

#include "sim/core/probe_sample.h"

namespace insonate {

/// Detects samples that a hand cannot have made: single strays, and those of a magnetic tracker that reports the sensor
/// as its mirror image in the other hemisphere.
///
/// A sample is expected at the last one, extrapolated by its velocity for as long as PoseHistory predicts. It is
/// accepted within 10 mm or 1 m/s of that, whichever is more, and within 15 degrees or 1080 degrees per second of the
/// last orientation. Other samples are rejected until they have lain together for 100 ms; then the probe is taken to be
/// there.
///
/// A sample is also rejected if its position is the mirror image, through a magnetic tracker's origin, of the expected
/// one. This lasts for as long as the samples stay on that side, however steady they are: the tracker does not recover
/// by itself, and the sensor has to be brought near its base.
class OutlierGate {
public:
  static constexpr double kNear_mm = 10, kNear_mm_per_s = 1000;
  static constexpr double kNear_deg = 15, kNear_deg_per_s = 1080;
  static constexpr double kBelieved_s = 0.100;

  /// Returns whether a hand can have made a usable sample. Times rise from call to call. `origin` is that of a magnetic
  /// tracker in the samples' frame; leave it empty for trackers that do not mirror.
  bool accepts(double time_s, const Pose& pose, const std::optional<glm::dvec3>& origin = {});

  /// Returns whether the last sample was rejected as a mirror image.
  bool mirrored() const { return mirrored_; }

private:
  struct Track {
    double time_s;
    Pose pose;
    glm::dvec3 mm_per_s{0};
  };
  bool follows(const Track& track, double time_s, const Pose& pose) const;
  static Track carried_on(const Track& track, double time_s, const Pose& pose);

  std::optional<Track> accepted_;   ///< while the samples are mirrored, the true position of the sensor
  std::optional<Track> elsewhere_;  ///< rejected samples that lie together
  double elsewhere_since_s_ = 0;
  bool mirrored_ = false;
};

}  // namespace insonate
