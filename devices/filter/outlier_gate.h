#pragma once

#include <glm/vec3.hpp>

#include <optional>

#include "sim/core/pose_sample.h"

namespace insonate {

/// Tells samples that no hand has made: single ones that lie elsewhere, and those of a magnetic tracker that takes the
/// sensor for its mirror image in the other hemisphere.
///
/// A sample is expected where the last one was, carried on by its velocity for as long as PoseHistory predicts. It is
/// believed within 10 mm or 1 m/s of that, whichever is more, and within 15 degrees or 1080 degrees a second of the
/// last orientation. Others are rejected until as many of them as fill 100 ms lie together: then the probe is there.
///
/// A sample whose position is the mirror image, through a magnetic tracker's origin, of where it was expected is
/// rejected for as long as the samples stay on that side, however steady they are: the tracker does not find back by
/// itself, the sensor has to be brought near its base.
class OutlierGate {
public:
  static constexpr double kNear_mm = 10, kNear_mm_per_s = 1000;
  static constexpr double kNear_deg = 15, kNear_deg_per_s = 1080;
  static constexpr double kBelieved_s = 0.100;

  /// Whether a usable sample is one that a hand has made; times rise from call to call. `origin` is that of
  /// a magnetic tracker in the samples' frame; others mirror nothing.
  bool accepts(double time_s, const Pose& pose, const std::optional<glm::dvec3>& origin = {});

  /// Whether the last sample was rejected as a mirror image.
  bool mirrored() const { return mirrored_; }

private:
  struct Track {
    double time_s;
    Pose pose;
    glm::dvec3 mm_per_s{0};
  };
  bool follows(const Track& track, double time_s, const Pose& pose) const;
  static Track carried_on(const Track& track, double time_s, const Pose& pose);

  std::optional<Track> accepted_;   ///< while the samples are mirrored, where the sensor really is
  std::optional<Track> elsewhere_;  ///< rejected samples that lie together
  double elsewhere_since_s_ = 0;
  bool mirrored_ = false;
};

}  // namespace insonate
