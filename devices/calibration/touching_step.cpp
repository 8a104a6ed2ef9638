#include "devices/calibration/touching_step.h"

#include <utility>

#include "devices/calibration/steps.h"

namespace insonate {

void TouchingStep::mark(double time_s) {
  if (done_ || held_.reading()) return;
  refusal_.clear();
  held_.begin(time_s,
              [this, touch = points_.size()](const Pose& raw) { return point(touch, base_.tracker_from_sensor(raw)); });
}

void TouchingStep::take(const PoseSample& sample) {
  const auto read = held_.take(sample);
  if (!read) return;
  if (!*read) {
    refusal_ = read->refusal();
    return;
  }
  wander_mm_ = (*read)->wander_mm;
  points_.push_back((*read)->mean_mm);
  if (points_.size() < touches_) return;
  refusal_ = finish();
  done_ = refusal_.empty();
  if (!done_) points_.clear();
}

void TouchingStep::undo() {
  held_.stop();
  refusal_.clear();
  if (std::exchange(done_, false))
    points_.clear();
  else if (!points_.empty())
    points_.pop_back();
}

SetupView TouchingStep::view() const {
  SetupView view;
  view.title = title_;
  view.refusal = refusal_;
  view.reading = held_.reading();
  view.done = done_;
  view.share = double(points_.size()) / double(touches_);
  view.part = points_.size();
  if (done_) {
    view.result = result();
    return view;
  }
  view.task = worded("%zu of %zu: ", points_.size() + 1, touches_) + task(points_.size());
  const auto read = held_.so_far();
  if (view.reading)
    view.feedback = read ? worded("Hold still: within %.1f mm.", read->wander_mm) : "Hold still.";
  else if (!points_.empty())
    view.feedback = worded("Read; the hand and the tracker wandered by %.1f mm.", wander_mm_);
  return view;
}

}  // namespace insonate
