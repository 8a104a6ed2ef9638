#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace insonate {

/// What is measured of a scan. The definitions of the view metrics are in view_meter.h, of the motion in
/// motion_meter.h.
enum class Metric {
  // Of one picture, against the step's reference view; judged as the mean over the hold (see runner.h).
  plane_distance_mm,
  in_plane_offset_mm,
  plane_angle_deg,
  tilt_deg,
  rock_deg,
  rotation_deg,
  off_centre_percent,
  target_in_view_percent,
  target_insonated_percent,
  landmarks_in_view_percent,
  depth_use_percent,
  // Of a step, by its kind (scenarios/steps).
  longest_hold_s,
  coverage_percent,
  kept_in_view_percent,
  knobs_right_percent,
  measurement_error_mm,
  measurement_error_percent,
  measurement_offset_mm,
  point_error_mm,
  labels_right_percent,
  answer_right_percent,
  answer_error,
  // Of a step or of the whole exam.
  time_s,
  path_length_mm,
  angular_path_deg,
  translational_movements,
  rotational_movements,
  skin_contact_percent,
  dropout_percent,
  dropouts,
  log_dimensionless_jerk,
  spectral_arc_length,
};

/// What a metric needs to be measurable.
enum class MetricScope {
  picture,  ///< one sample and a reference view: also usable as a tolerance
  step,     ///< one step of a kind that measures it
  motion    ///< any stretch of samples: also usable for the whole exam
};

struct MetricInfo {
  Metric metric;
  std::string_view name;   ///< as scenario files and JSON spell it: "plane_distance_mm"
  std::string_view unit;   ///< as people read it after a number: "mm", "\u00b0", "%"; empty for counts
  std::string_view words;  ///< as a report says it: "Distance of the target from the picture's plane"
  MetricScope scope;
  bool less_is_better;
  bool needs_targets;    ///< the view must name targets that are in the case's labels
  bool needs_landmarks;  ///< the view must name landmarks
  bool economy;          ///< of effort: earns points only where the task was done, or giving up at once would pay
  int decimals;          ///< worth showing
};

/// All of them, in the order of the enumeration.
std::span<const MetricInfo> metrics();

const MetricInfo& info(Metric metric);

/// The metric of that name, if there is one.
std::optional<Metric> find_metric(std::string_view name);

}  // namespace insonate
