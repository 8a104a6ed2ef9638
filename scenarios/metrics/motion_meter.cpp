#include "scenarios/metrics/motion_meter.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace insonate {

std::optional<double> MotionValues::of(Metric motion_metric) const {
  switch (motion_metric) {
    case Metric::time_s:
      return time_s;
    case Metric::dropout_percent:
      return time_s > 0 ? 100 * untracked_s / time_s : 0;
    case Metric::dropouts:
      return dropouts;
    default:
      break;
  }
  if (!(tracked_s > 0)) return std::nullopt;
  switch (motion_metric) {
    case Metric::path_length_mm:
      return path_length_mm;
    case Metric::angular_path_deg:
      return angular_path_deg;
    case Metric::translational_movements:
      return translational_movements;
    case Metric::rotational_movements:
      return rotational_movements;
    case Metric::log_dimensionless_jerk:
      return log_dimensionless_jerk;
    case Metric::spectral_arc_length:
      return spectral_arc_length;
    case Metric::skin_contact_percent:
      return 100 * on_skin_s / tracked_s;
    default:
      return std::nullopt;  // not a motion metric
  }
}

void MotionMeter::Movements::see(long grid, double speed, double limit) {
  if (!(speed > limit)) return;
  // Grid steps are counted because time differences round up or down.
  constexpr long kJoinedSteps = 4;
  static_assert(kJoinedSteps / kRate_hz == kJoined_s);
  if (!last_moving || grid - 1 - *last_moving >= kJoinedSteps) ++count;
  last_moving = grid;
}

void MotionMeter::feed(const ProbeSample& sample, bool on_skin) {
  const bool valid = sample.status == PoseStatus::ok;
  if (!any_) {
    any_ = true;
    start_s_ = last_s_ = sample.time_s;
    path_ = PathGrid(start_s_);
  } else {
    pass(sample.time_s, valid && last_valid_ && bridges(sample.time_s - last_s_), on_skin);
    in_dropout_ = !valid;
  }
  if (valid)
    path_.feed(sample.time_s, sample.patient_from_probe,
               [this](long grid, const Pose& pose, bool follows) { grid_pose(grid, pose, follows); });
  last_valid_ = valid;
  last_on_skin_ = on_skin;
}

MotionValues& MotionValues::operator+=(const MotionValues& later) {
  time_s += later.time_s;
  path_length_mm += later.path_length_mm;
  angular_path_deg += later.angular_path_deg;
  translational_movements += later.translational_movements;
  rotational_movements += later.rotational_movements;
  tracked_s += later.tracked_s;
  on_skin_s += later.on_skin_s;
  untracked_s += later.untracked_s;
  dropouts += later.dropouts;
  const auto less_smooth = [](std::optional<double>& mine, const std::optional<double>& other) {
    if (!mine || (other && *other < *mine)) mine = other;
  };
  less_smooth(log_dimensionless_jerk, later.log_dimensionless_jerk);
  less_smooth(spectral_arc_length, later.spectral_arc_length);
  return *this;
}

void MotionMeter::end(double time_s) {
  if (any_) pass(time_s, last_valid_ && bridges(time_s - last_s_), last_on_skin_);
}

MotionMeter MotionMeter::following(double time_s) const {
  MotionMeter next;
  next.any_ = any_;
  next.start_s_ = next.last_s_ = time_s;
  next.last_valid_ = last_valid_;
  next.last_on_skin_ = last_on_skin_;
  next.path_ = path_.following(time_s);
  return next;
}

void MotionMeter::pass(double time_s, bool tracked, bool on_skin_at_end) {
  const double dt = time_s - last_s_;
  values_.time_s = time_s - start_s_;
  if (tracked) {
    values_.tracked_s += dt;
    values_.on_skin_s += dt * (int(last_on_skin_) + int(on_skin_at_end)) / 2;
  } else if (dt > 0) {
    values_.untracked_s += dt;
    values_.dropouts += !in_dropout_;
    in_dropout_ = true;
  }
  last_s_ = time_s;
}

void MotionMeter::grid_pose(long grid, const Pose& pose, bool follows) {
  smoothness_.feed(pose.translation, follows);
  if (follows) {
    const double shift = glm::distance(pose.translation, last_grid_pose_.translation);
    const double turn = angle_between_deg(last_grid_pose_, pose);
    values_.path_length_mm += shift;
    values_.angular_path_deg += turn;
    speed_mm_s_ = shift * kRate_hz;
    shifts_.see(grid, shift * kRate_hz, kMoving_mm_s);
    turns_.see(grid, turn * kRate_hz, kMoving_deg_s);
    values_.translational_movements = shifts_.count;
    values_.rotational_movements = turns_.count;
  }
  last_grid_pose_ = pose;
}

MotionValues MotionMeter::values() const {
  MotionValues values = values_;
  values.log_dimensionless_jerk = smoothness_.log_dimensionless_jerk();
  values.spectral_arc_length = smoothness_.spectral_arc_length();
  return values;
}

}  // namespace insonate
