#include "devices/mouse/mouse_tracker.h"

#include <cmath>

#include "devices/rotation.h"
#include "sim/core/input_error.h"

namespace insonate {

MouseTracker::MouseTracker(const Pose& patient_from_probe) : Tracker("mouse and keyboard") {
  place(patient_from_probe);
}

void MouseTracker::move(const glm::dvec3& mm, const glm::dvec3& rad) {
  pending_mm_ += mm;
  pending_rad_ += rad;
}

void MouseTracker::move_steadily(const glm::dvec3& mm_per_s, const glm::dvec3& rad_per_s) {
  mm_per_s_ = mm_per_s;
  rad_per_s_ = rad_per_s;
}

void MouseTracker::place(const Pose& patient_from_probe) {
  rotation_ = glm::normalize(glm::quat_cast(patient_from_probe.rotation));
  translation_ = patient_from_probe.translation;
  pending_mm_ = pending_rad_ = glm::dvec3(0);
}

Pose MouseTracker::pose() const {
  return {glm::mat3_cast(rotation_), translation_};
}

void MouseTracker::collect(double now_s, std::vector<ProbeSample>& samples) {
  if (!start_s_) start_s_ = now_s;
  const auto due = std::uint64_t(std::floor((now_s - *start_s_) * kRate_hz)) + 1;
  if (due <= next_) return;
  const double share = 1.0 / double(due - next_);
  // In the frame that the probe has now: a probe that is moved and turned at once ends where it was sent.
  const glm::dvec3 step_mm = rotation_ * (pending_mm_ * share);
  const glm::dquat step_turn = rotation_from_vector(pending_rad_ * share + rad_per_s_ / kRate_hz);
  pending_mm_ = pending_rad_ = glm::dvec3(0);
  for (; next_ < due; ++next_) {
    translation_ += step_mm + rotation_ * (mm_per_s_ / kRate_hz);
    // A probe at rest keeps its pose bit for bit. Otherwise rounding in normalize() would cause a redraw.
    if (step_turn != glm::dquat(1, 0, 0, 0)) rotation_ = glm::normalize(rotation_ * step_turn);
    samples.push_back({double(next_) / kRate_hz, PoseStatus::ok, pose(), buttons_});
  }
}

std::unique_ptr<Tracker> open_mouse(const TrackerUri& uri, const TrackerContext& context) {
  uri.allow_options({});
  if (!uri.subject.empty())
    throw InputError("tracker '" + uri.text + "'", "", "the mouse needs no name", "write just 'mouse:'");
  return std::make_unique<MouseTracker>(context.start);
}

}  // namespace insonate
