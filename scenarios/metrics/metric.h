#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace insonate {

/// The quantities measured in a scan. view_meter.h defines the view metrics, motion_meter.h the motion metrics.
enum class Metric {
  // One picture, compared with the step's reference view; scored as the mean over the hold (runner.h).
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
  // A step, measured by its kind (scenarios/steps).
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
  // A step or the whole exam.
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

/// What a metric is measured from.
enum class MetricScope {
  picture,  ///< one sample and a reference view: also usable as a tolerance
  step,     ///< one step of a kind that measures it
  motion    ///< any interval of samples: also usable for the whole exam
};

/// The description of a metric.
struct MetricInfo {
  Metric metric;
  std::string_view name;   ///< name in scenario files and JSON: "plane_distance_mm"
  std::string_view unit;   ///< unit shown after a number: "mm", "\u00b0", "%"; empty for counts
  std::string_view words;  ///< name in reports: "Distance of the target from the picture's plane"
  MetricScope scope;
  bool less_is_better;
  bool needs_targets;    ///< the view must name targets that are in the case's labels
  bool needs_landmarks;  ///< the view must name landmarks
  bool economy;  ///< measures effort: earns points only if the task was done, because otherwise giving up at once would
                 ///< pay
  int decimals;  ///< decimal places to show
  bool of_reference = false;  ///< 100 % is what the reference view shows, so a picture can have more
};

/// Returns all metrics, in the order of the enumeration.
std::span<const MetricInfo> metrics();

/// Returns the description of a metric.
const MetricInfo& info(Metric metric);

/// Returns the metric of that name, if it exists.
std::optional<Metric> find_metric(std::string_view name);

}  // namespace insonate
