#include "scenarios/metrics/metric.h"

#include <array>

namespace insonate {
namespace {

using enum MetricScope;

constexpr std::array kMetrics{
    // metric, name, unit, words, scope, less is better, needs targets, needs landmarks, economy, decimals,
    // of the reference
    MetricInfo{Metric::plane_distance_mm, "plane_distance_mm", "mm", "Distance of the target from the plane", picture,
               true, false, false, false, 1},
    MetricInfo{Metric::in_plane_offset_mm, "in_plane_offset_mm", "mm", "Shift of the target within the picture",
               picture, true, false, false, false, 1},
    MetricInfo{Metric::plane_angle_deg, "plane_angle_deg", "\u00b0", "Angle to the reference plane", picture, true,
               false, false, false, 1},
    MetricInfo{Metric::tilt_deg, "tilt_deg", "\u00b0", "Tilt off the reference", picture, true, false, false, false, 1},
    MetricInfo{Metric::rock_deg, "rock_deg", "\u00b0", "Rock off the reference", picture, true, false, false, false, 1},
    MetricInfo{Metric::rotation_deg, "rotation_deg", "\u00b0", "Rotation off the reference", picture, true, false,
               false, false, 1},
    MetricInfo{Metric::off_centre_percent, "off_centre_percent", "%", "Target off the middle of the picture", picture,
               true, true, false, false, 0},
    MetricInfo{Metric::target_in_view_percent, "target_in_view_percent", "%", "Target in the picture", picture, false,
               true, false, false, 0, true},
    MetricInfo{Metric::target_insonated_percent, "target_insonated_percent", "%", "Target reached by the sound",
               picture, false, true, false, false, 0, true},
    MetricInfo{Metric::landmarks_in_view_percent, "landmarks_in_view_percent", "%", "Landmarks in the picture", picture,
               false, false, true, false, 0},
    MetricInfo{Metric::depth_use_percent, "depth_use_percent", "%",
               "Share of the picture's depth that the target takes", picture, false, true, false, false, 0},
    MetricInfo{Metric::longest_hold_s, "longest_hold_s", "s", "View held", step, false, false, false, false, 2},
    MetricInfo{Metric::coverage_percent, "coverage_percent", "%", "Share of the organ that was seen", step, false,
               false, false, false, 0},
    MetricInfo{Metric::kept_in_view_percent, "kept_in_view_percent", "%", "Time with the landmarks in the picture",
               step, false, false, false, false, 0},
    MetricInfo{Metric::knobs_right_percent, "knobs_right_percent", "%", "Knobs set as asked", step, false, false, false,
               false, 0},
    MetricInfo{Metric::measurement_error_mm, "measurement_error_mm", "mm", "Error of the measurement", step, true,
               false, false, false, 1},
    MetricInfo{Metric::measurement_error_percent, "measurement_error_percent", "%", "Relative error of the measurement",
               step, true, false, false, false, 1},
    MetricInfo{Metric::measurement_offset_mm, "measurement_offset_mm", "mm", "Measured away from the place", step, true,
               false, false, false, 1},
    MetricInfo{Metric::point_error_mm, "point_error_mm", "mm", "Distance of the mark from its goal", step, true, false,
               false, false, 1},
    MetricInfo{Metric::labels_right_percent, "labels_right_percent", "%", "Structures named rightly", step, false,
               false, false, false, 0},
    MetricInfo{Metric::answer_right_percent, "answer_right_percent", "%", "Right answer", step, false, false, false,
               false, 0},
    MetricInfo{Metric::answer_error, "answer_error", "", "Error of the answer", step, true, false, false, false, 2},
    MetricInfo{Metric::time_s, "time_s", "s", "Time taken", motion, true, false, false, true, 1},
    MetricInfo{Metric::path_length_mm, "path_length_mm", "mm", "Path of the probe", motion, true, false, false, true,
               0},
    MetricInfo{Metric::angular_path_deg, "angular_path_deg", "\u00b0", "Turning of the probe", motion, true, false,
               false, true, 0},
    MetricInfo{Metric::translational_movements, "translational_movements", "", "Separate shifts of the probe", motion,
               true, false, false, true, 0},
    MetricInfo{Metric::rotational_movements, "rotational_movements", "", "Separate turns of the probe", motion, true,
               false, false, true, 0},
    MetricInfo{Metric::skin_contact_percent, "skin_contact_percent", "%", "Time with the face on the skin", motion,
               false, false, false, false, 0},
    MetricInfo{Metric::dropout_percent, "dropout_percent", "%", "Time without tracking", motion, true, false, false,
               false, 1},
    MetricInfo{Metric::dropouts, "dropouts", "", "Losses of tracking", motion, true, false, false, false, 0},
    MetricInfo{Metric::log_dimensionless_jerk, "log_dimensionless_jerk", "", "Smoothness, log dimensionless jerk",
               motion, false, false, false, true, 1},
    MetricInfo{Metric::spectral_arc_length, "spectral_arc_length", "", "Smoothness, spectral arc length", motion, false,
               false, false, true, 2},
};

constexpr bool in_order_of_enumeration() {
  for (std::size_t i = 0; i < kMetrics.size(); ++i)
    if (std::size_t(kMetrics[i].metric) != i) return false;
  return true;
}
static_assert(in_order_of_enumeration());

}  // namespace

std::span<const MetricInfo> metrics() {
  return kMetrics;
}

const MetricInfo& info(Metric metric) {
  return kMetrics[std::size_t(metric)];
}

std::optional<Metric> find_metric(std::string_view name) {
  for (const MetricInfo& m : kMetrics)
    if (m.name == name) return m.metric;
  return std::nullopt;
}

}  // namespace insonate
