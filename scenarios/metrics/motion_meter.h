#pragma once

#include <glm/vec3.hpp>

#include <optional>

#include "scenarios/metrics/metric.h"
#include "scenarios/metrics/path_grid.h"
#include "scenarios/metrics/smoothness.h"
#include "sim/core/pose_sample.h"

namespace insonate {

/// How a probe was moved during a stretch of samples.
struct MotionValues {
  double time_s = 0;
  double path_length_mm = 0;                     ///< of the middle of the face
  double angular_path_deg = 0;                   ///< of the whole orientation
  int translational_movements = 0;               ///< stretches faster than kMoving_mm_s
  int rotational_movements = 0;                  ///< stretches faster than kMoving_deg_s
  double tracked_s = 0;                          ///< between valid samples that follow each other
  double on_skin_s = 0;                          ///< of tracked_s
  double untracked_s = 0;                        ///< the rest
  int dropouts = 0;                              ///< stretches of untracked time
  std::optional<double> log_dimensionless_jerk;  ///< of smoothness.h; empty without motion
  std::optional<double> spectral_arc_length;

  /// Empty for what cannot be said of a stretch without tracked time.
  std::optional<double> of(Metric motion_metric) const;

  /// Adds a stretch that comes later. Smoothness does not add up: it is that of the less smooth one.
  MotionValues& operator+=(const MotionValues& later);
};

/// Measures motion, one sample after the other.
///
/// Path and speed are taken from poses interpolated at kRate_hz from the meter's first sample on, not from the samples
/// themselves: otherwise a faster tracker would sum up more of its own noise, and the same scan would get a longer
/// path. Speeds are differences of positions and orientations, never of matrices multiplied with inverses, whose
/// translation grows with the distance from the origin. An interval between samples counts as tracked when both are
/// valid and no more than kBridged_s apart, give or take kTimeRounding_s; over losses up to kBridged_s the motion is
/// interpolated, over longer ones it is unknown and left out.
class MotionMeter {
public:
  static constexpr double kRate_hz = PathGrid::kRate_hz;
  static constexpr double kMoving_mm_s = 50;
  static constexpr double kMoving_deg_s = 50;
  static constexpr double kJoined_s = 0.2;  ///< a shorter rest does not end a movement
  static constexpr double kBridged_s = PathGrid::kBridged_s;

  /// Whether the time between two valid samples counts as tracked.
  static bool bridges(double gap_s) { return PathGrid::bridges(gap_s); }

  /// @param on_skin  whether the sample's face is on the skin; only looked at for valid samples
  void feed(const PoseSample& sample, bool on_skin);

  /// Ends the stretch at a time after the last sample.
  void end(double time_s);

  /// A meter for the stretch that follows, from that time on. It knows the last sample, so that no motion between the
  /// two stretches is lost.
  MotionMeter following(double time_s) const;

  /// The smoothness is worked out here: some milliseconds for an exam of minutes.
  MotionValues values() const;

  /// Speed over the last step of the grid; 0 before there is one.
  double speed_mm_s() const { return speed_mm_s_; }

private:
  /// Counts stretches above a speed, joined over short rests.
  struct Movements {
    std::optional<long> last_moving;  ///< the step of the grid that ends there
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
