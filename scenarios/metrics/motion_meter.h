#pragma once

#include <glm/vec3.hpp>

#include <optional>

#include "scenarios/metrics/metric.h"
#include "scenarios/metrics/path_grid.h"
#include "scenarios/metrics/smoothness.h"
#include "sim/core/probe_sample.h"

namespace insonate {

/// The motion of a probe during an interval of samples.
struct MotionValues {
  double time_s = 0;
  double path_length_mm = 0;                     ///< path of the centre of the face
  double angular_path_deg = 0;                   ///< sum of the changes of orientation
  int translational_movements = 0;               ///< intervals faster than kMoving_mm_s
  int rotational_movements = 0;                  ///< intervals faster than kMoving_deg_s
  double tracked_s = 0;                          ///< time between consecutive valid samples
  double on_skin_s = 0;                          ///< part of tracked_s
  double untracked_s = 0;                        ///< the remaining time
  int dropouts = 0;                              ///< intervals of untracked time
  std::optional<double> log_dimensionless_jerk;  ///< see smoothness.h; empty without motion
  std::optional<double> spectral_arc_length;

  /// Returns the value of a motion metric, or nothing if it is undefined without tracked time.
  std::optional<double> of(Metric motion_metric) const;

  /// Adds a later interval. Smoothness does not add up; the sum takes the less smooth of the two values.
  MotionValues& operator+=(const MotionValues& later);
};

/// Measures motion, sample by sample.
///
/// Path and speed come from poses interpolated at kRate_hz from the meter's first sample on, not from the samples
/// themselves. Otherwise a faster tracker would add up more of its own noise, and the same scan would get a longer
/// path. Speeds are differences of positions and orientations. They are never computed by multiplying a matrix with an
/// inverse, because the translation of such a product grows with the distance from the origin. An interval between
/// samples counts as tracked if both are valid and at most kBridged_s apart, within kTimeRounding_s. Motion is
/// interpolated over losses up to kBridged_s. Over longer losses it is unknown and left out.
class MotionMeter {
public:
  static constexpr double kRate_hz = PathGrid::kRate_hz;
  static constexpr double kMoving_mm_s = 50;
  static constexpr double kMoving_deg_s = 50;
  static constexpr double kJoined_s = 0.2;  ///< a shorter pause does not end a movement
  static constexpr double kBridged_s = PathGrid::kBridged_s;

  /// Returns true if the time between two valid samples counts as tracked.
  static bool bridges(double gap_s) { return PathGrid::bridges(gap_s); }

  /// Processes one sample.
  /// @param on_skin  true if the sample's face is on the skin; used for valid samples only
  void feed(const ProbeSample& sample, bool on_skin);

  /// Ends the interval at a time after the last sample.
  void end(double time_s);

  /// Returns a meter for the following interval, which starts at `time_s`. It knows the last sample, so that no motion
  /// between the two intervals is lost.
  MotionMeter following(double time_s) const;

  /// Returns the values so far. This call computes the smoothness, which takes some milliseconds for an exam of
  /// minutes.
  MotionValues values() const;

  /// Returns the speed over the last grid interval; 0 before the first.
  double speed_mm_s() const { return speed_mm_s_; }

private:
  /// Counts intervals above a speed; pauses shorter than kJoined_s do not separate them.
  struct Movements {
    std::optional<long> last_moving;  ///< grid index at the end of the last interval above the speed
    int count = 0;
    void see(long grid, double speed, double limit);
  };
  void pass(double time_s, bool tracked, bool on_skin_at_end);
  void grid_pose(long grid, const Pose& pose, bool follows);

  MotionValues values_;
  double start_s_ = 0;
  double last_s_ = 0;
  bool last_valid_ = false;
  bool last_on_skin_ = false;
  bool in_dropout_ = false;
  bool any_ = false;
  PathGrid path_;
  Pose last_grid_pose_;
  Smoothness smoothness_{kRate_hz};
  double speed_mm_s_ = 0;
  Movements shifts_;
  Movements turns_;
};

}  // namespace insonate
