#include "devices/filter/one_euro.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "devices/rotation.h"

namespace insonate {
namespace {

/// Returns the weight of a new value in a first-order low-pass filter that is sampled every `step_s`.
double share(double cutoff_hz, double step_s) {
  return 1 / (1 + 1 / (glm::two_pi<double>() * cutoff_hz * step_s));
}

}  // namespace

Pose OneEuroFilter::smooth(double time_s, const Pose& pose) {
  const glm::dquat turn = glm::quat_cast(pose.rotation);
  const double step_s = state_ ? time_s - state_->time_s : 0;
  if (!(step_s > 0) || step_s > kRestart_s) {
    state_ = State{time_s, pose.translation, glm::dvec3(0), turn, glm::dvec3(0)};
    return pose;
  }
  State& last = *state_;
  const double speed_share = share(options_.speed_hz, step_s);
  const glm::dvec3 mm = pose.translation - last.mm, rad = rotation_vector(glm::conjugate(last.turn) * turn);
  last.mm_per_s += speed_share * (mm / step_s - last.mm_per_s);
  last.rad_per_s += speed_share * (rad / step_s - last.rad_per_s);
  const double mm_hz = options_.least_hz + options_.hz_per_mm_per_s * glm::length(last.mm_per_s);
  const double rad_hz = options_.least_hz + options_.hz_per_rad_per_s * glm::length(last.rad_per_s);
  last.mm += share(mm_hz, step_s) * mm;
  last.turn = glm::normalize(last.turn * rotation_from_vector(share(rad_hz, step_s) * rad));
  last.time_s = time_s;
  return {glm::mat3_cast(last.turn), last.mm};
}

}  // namespace insonate
