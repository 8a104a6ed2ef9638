#include "devices/filter/outlier_gate.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace insonate {
namespace {

/// A velocity predicts the position of a hand for kCarry_s at most (PoseHistory::kPredict_s). After kLongestGap_s the
/// possible distance no longer grows.
constexpr double kCarry_s = 0.030, kLongestGap_s = 0.250;
/// Samples from one read have stamps that do not show how quickly they followed each other.
constexpr double kMinStep_s = 0.0005;

/// Returns the pose as a tracker reports it in the wrong hemisphere: the position mirrored through its origin.
Pose mirror_image(const Pose& pose, const glm::dvec3& origin) {
  return {pose.rotation, 2.0 * origin - pose.translation};
}

}  // namespace

bool OutlierGate::follows(const Track& track, double time_s, const Pose& pose) const {
  const double step_s = std::min(time_s - track.time_s, kLongestGap_s);
  const glm::dvec3 expected = track.pose.translation + track.mm_per_s * std::min(step_s, kCarry_s);
  return glm::distance(pose.translation, expected) <= std::max(kNear_mm, kNear_mm_per_s * step_s) &&
         angle_between_deg(pose, track.pose) <= std::max(kNear_deg, kNear_deg_per_s * step_s);
}

OutlierGate::Track OutlierGate::carried_on(const Track& track, double time_s, const Pose& pose) {
  const double step_s = time_s - track.time_s;
  if (step_s < kMinStep_s) return {time_s, pose, track.mm_per_s};
  // A step over a longer gap gives no velocity, and the noise of a single step must not carry far.
  if (step_s > kLongestGap_s) return {time_s, pose};
  glm::dvec3 mm_per_s = (pose.translation - track.pose.translation) / step_s;
  mm_per_s = 0.5 * (mm_per_s + track.mm_per_s);
  const double speed = glm::length(mm_per_s);
  if (speed > kNear_mm_per_s) mm_per_s *= kNear_mm_per_s / speed;
  return {time_s, pose, mm_per_s};
}

bool OutlierGate::accepts(double time_s, const Pose& pose, const std::optional<glm::dvec3>& origin) {
  mirrored_ = false;
  if (!accepted_) {
    accepted_ = Track{time_s, pose};
    return true;
  }
  if (follows(*accepted_, time_s, pose)) {
    accepted_ = carried_on(*accepted_, time_s, pose);
    elsewhere_.reset();
    return true;
  }
  if (origin) {
    if (const Pose image = mirror_image(pose, *origin); follows(*accepted_, time_s, image)) {
      accepted_ = carried_on(*accepted_, time_s, image);
      elsewhere_.reset();
      mirrored_ = true;
      return false;
    }
  }
  const bool together = elsewhere_ && follows(*elsewhere_, time_s, pose);
  if (!together) elsewhere_since_s_ = time_s;
  elsewhere_ = together ? carried_on(*elsewhere_, time_s, pose) : Track{time_s, pose};
  if (time_s - elsewhere_since_s_ < kBelieved_s) return false;
  accepted_ = elsewhere_;
  elsewhere_.reset();
  return true;
}

}  // namespace insonate
