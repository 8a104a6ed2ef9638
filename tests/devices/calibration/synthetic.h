#pragma once

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/core/hash.h"
#include "sim/core/pose.h"

namespace insonate {

/// Draws simulated measurements that are the same every time.
class Dice {
public:
  explicit Dice(std::uint32_t seed) : seed_(seed) {}

  double uniform(double least, double most) {
    return least + (most - least) * double(unit_float(hash(seed_, next_++)));
  }
  double normal(double deviation) {  // Box-Muller transform
    return deviation * std::sqrt(-2 * std::log(1 - uniform(0, 1))) * std::cos(uniform(0, 2 * 3.14159265358979));
  }
  /// Returns noise of that standard deviation along each axis.
  glm::dvec3 noise(double deviation) { return {normal(deviation), normal(deviation), normal(deviation)}; }
  glm::dvec3 point(double reach) { return {uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach)}; }
  Pose pose(double reach) {
    const glm::dquat turn(normal(1), normal(1), normal(1), normal(1));
    return {glm::mat3_cast(glm::normalize(turn)), point(reach)};
  }

private:
  std::uint32_t seed_, next_ = 0;
};

inline Pose turned(double deg, const glm::dvec3& axis, const glm::dvec3& at = glm::dvec3(0)) {
  return {glm::mat3_cast(glm::angleAxis(glm::radians(deg), glm::normalize(axis))), at};
}

/// Returns poses tracker_from_sensor of a probe that is tilted about its tip by up to `tilt_deg` in all directions, and
/// rolled.
inline std::vector<Pose> pivoting(Dice& dice, const Pose& start, const glm::dvec3& tip, const glm::dvec3& pivot,
                                  double tilt_deg, double roll_deg, int count, double noise_mm) {
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    const double side = dice.uniform(0, 360);
    const glm::dvec3 axis(std::cos(glm::radians(side)), std::sin(glm::radians(side)), 0);
    const Pose turn = turned(dice.uniform(0, tilt_deg), axis) * turned(dice.uniform(-roll_deg, roll_deg), {0, 0, 1});
    Pose pose{start.rotation * turn.rotation, {}};
    pose.translation = pivot - pose.rotation * tip + dice.noise(noise_mm);
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace insonate
