#include "devices/calibration/steps/touching_step.h"

#include "devices/calibration/steps/steps.h"
#include "sim/core/text.h"

namespace insonate {

void TouchingStep::marked(double time_s) {
  if (held_.reading()) return;
  held_.begin(time_s,
              [this, touch = points_.size()](const Pose& raw) { return point(touch, base_.tracker_from_sensor(raw)); });
}

void TouchingStep::take(const SensorSample& sample) {
  const auto read = held_.take(sample);
  if (!read) return;
  if (!*read) {
    refuse(read->refusal());
    return;
  }
  wander_mm_ = (*read)->wander_mm;
  points_.push_back((*read)->mean_mm);
  if (points_.size() < touches_) return;
  finish();
  if (!done()) points_.clear();
}

void TouchingStep::taken_back(bool all) {
  held_.stop();
  if (all)
    points_.clear();
  else if (!points_.empty())
    points_.pop_back();
}

void TouchingStep::ask(SetupView& view) const {
  view.reading = held_.reading();
  view.share = double(points_.size()) / double(touches_);
  view.task = formatted("%zu of %zu: ", points_.size() + 1, touches_) + task(points_.size());
  const auto read = held_.so_far();
  if (view.reading)
    view.feedback = read ? formatted("Hold still: within %.1f mm.", read->wander_mm) : "Hold still.";
  else if (!points_.empty())
    view.feedback = formatted("Read; the hand and the tracker wandered by %.1f mm.", wander_mm_);
}

}  // namespace insonate
