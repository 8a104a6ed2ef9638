#include "devices/pose_history.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>

#include "devices/rotation.h"

namespace insonate {
namespace {

// Newest samples through which a line is fitted for the velocity: of several numbers tried, this one predicted best.
constexpr std::size_t kFitted = 13;

}  // namespace

std::string_view to_string(PoseAnswer answer) {
  switch (answer) {
    case PoseAnswer::exact:
      return "exact";
    case PoseAnswer::interpolated:
      return "interpolated";
    case PoseAnswer::predicted:
      return "predicted";
    case PoseAnswer::held:
      return "held";
    case PoseAnswer::stale:
      return "stale";
    case PoseAnswer::none:
      return "none";
  }
  return "none";
}

void PoseHistory::add(const ProbeSample& sample) {
  if (!(sample.time_s > newest_s_)) clear();
  newest_s_ = sample.time_s;
  if (sample.status == PoseStatus::ok)
    usable_.push_back({sample.time_s, sample.patient_from_probe});
  else if (!usable_.empty())
    usable_.back().unusable_from_s = std::min(usable_.back().unusable_from_s, sample.time_s);
  // The newest usable sample is kept however old it is, with those that give its velocity: the picture is frozen there.
  while (!usable_.empty() && usable_.front().time_s < usable_.back().time_s - kKept_s) usable_.pop_front();
}

void PoseHistory::clear() {
  usable_.clear();
  newest_s_ = -std::numeric_limits<double>::infinity();
}

PoseEstimate PoseHistory::at(double time_s, double predict_s) const {
  const auto next = std::lower_bound(usable_.begin(), usable_.end(), time_s,
                                     [](const Entry& entry, double time) { return entry.time_s < time; });
  if (next != usable_.end() && next->time_s == time_s) return {PoseAnswer::exact, next->pose, 0};
  if (next == usable_.begin()) return {};
  const Entry& last = *(next - 1);
  if (next == usable_.end() || next->time_s - last.time_s > kBridge_s)
    return after(std::size_t(next - 1 - usable_.begin()), time_s, predict_s);
  const double t = (time_s - last.time_s) / (next->time_s - last.time_s);
  return {PoseAnswer::interpolated, interpolate(last.pose, next->pose, t), time_s - last.time_s};
}

PoseEstimate PoseHistory::after(std::size_t index, double time_s, double predict_s) const {
  const Entry& last = usable_[index];
  const double age_s = time_s - last.time_s;
  const double horizon_s = std::min({predict_s, kPredict_s, last.unusable_from_s - last.time_s});
  const PoseAnswer how = age_s <= horizon_s  ? PoseAnswer::predicted
                         : age_s <= kStale_s ? PoseAnswer::held
                                             : PoseAnswer::stale;
  return {how, predict(index, std::min(age_s, horizon_s)), age_s};
}

Pose PoseHistory::predict(std::size_t index, double ahead_s) const {
  const Entry& last = usable_[index];
  std::size_t first = index;
  while (first > 0 && index - first + 1 < kFitted && last.time_s - usable_[first - 1].time_s <= kBridge_s) --first;
  const auto count = double(index - first + 1);

  // Slopes of the least-squares lines through translation and rotation against time, both relative to the last sample.
  // The prediction starts from that sample, so the pose does not jump.
  double mean_s = 0, spread = 0;
  for (std::size_t i = first; i <= index; ++i) mean_s += (usable_[i].time_s - last.time_s) / count;
  glm::dvec3 mm(0), rad(0);
  for (std::size_t i = first; i <= index; ++i) {
    const double t = usable_[i].time_s - last.time_s - mean_s;
    spread += t * t;
    mm += (usable_[i].pose.translation - last.pose.translation) * t;
    rad += rotation_vector(glm::quat_cast(glm::transpose(last.pose.rotation) * usable_[i].pose.rotation)) * t;
  }
  if (!(spread > 0)) return last.pose;
  mm *= ahead_s / spread;
  rad *= ahead_s / spread;
  return {last.pose.rotation * glm::mat3_cast(rotation_from_vector(rad)), last.pose.translation + mm};
}

}  // namespace insonate
