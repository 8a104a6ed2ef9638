#include "app/session/probe_hand.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

#include "sim/model/skin_contact.h"

namespace insonate {
namespace {

/// Where the search for the skin starts, behind the face along the beam, and how far it goes.
constexpr double kBehind_mm = 45;
constexpr double kSearch_mm = 120;
/// The CT cuts the body half a slice beyond the outermost slices' middles. What a line meets within this many slices of
/// these is taken for the cut.
constexpr double kCut_slices = 0.5;
/// The skin's slope is taken over about the width of a face, so that ribs and the navel do not tilt the probe.
constexpr double kSlope_mm = 18;
constexpr double kSteepest_mm = 2 * kSlope_mm;
/// A beam that runs closer along the skin than this faces none.
constexpr double kLeastFacing = 0.5;

/// Returns the smallest rotation that takes one unit vector to another.
glm::dmat3 turn_between(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 axis = glm::cross(a, b);
  const double sine = glm::length(axis);
  if (sine < 1e-9) return glm::dmat3(1.0);
  return glm::mat3_cast(glm::angleAxis(std::atan2(sine, glm::dot(a, b)), axis / sine));
}

glm::dmat3 orthonormal(const glm::dmat3& m) {
  return glm::mat3_cast(glm::normalize(glm::quat_cast(m)));
}

}  // namespace

/// Returns where a line meets the skin. Empty if it starts inside the body, because something else blocks it then, or
/// meets a cut face of the CT.
std::optional<glm::dvec3> ProbeHand::skin(const glm::dvec3& from, const glm::dvec3& direction,
                                          double farthest_mm) const {
  const auto distance = distance_to_skin(*ct_, from, direction, farthest_mm);
  if (!distance || *distance <= 0) return std::nullopt;
  const glm::dvec3 met = from + *distance * direction;
  const Grid& grid = ct_->grid;
  int along = 2;  // the axis of the grid that runs from feet to head
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(grid.direction[axis].z) > std::abs(grid.direction[along].z)) along = axis;
  const double slice = grid.index_from_patient(met)[along];
  if (slice < kCut_slices || slice > grid.size[along] - 1 - kCut_slices) return std::nullopt;
  return met;
}

/// Returns the skin's normal at a point of it, unit, by where there is body around the point. It depends on no line of
/// sight, which may run along the skin. Empty if there is as much body on every side.
std::optional<glm::dvec3> ProbeHand::inward(const glm::dvec3& point) const {
  constexpr int kSteps = 3;
  constexpr double kStep_mm = kSlope_mm / kSteps;
  const auto body = [&](const glm::dvec3& p) { return distance_to_skin(*ct_, p, {0, 1, 0}, 0).has_value(); };
  glm::dvec3 sum(0);
  for (int k = -kSteps; k <= kSteps; ++k)
    for (int j = -kSteps; j <= kSteps; ++j)
      for (int i = -kSteps; i <= kSteps; ++i) {
        const glm::dvec3 aside = kStep_mm * glm::dvec3(i, j, k);
        if (glm::length(aside) > kSlope_mm) continue;
        if (body(point + aside) && !body(point - aside)) sum += aside;
      }
  const double length = glm::length(sum);
  if (length < kStep_mm) return std::nullopt;
  return sum / length;
}

std::optional<ProbeHand::Contact> ProbeHand::contact(const Pose& pose) const {
  const glm::dvec3 beam = pose.rotation[1];
  const auto below = [&](double x, double z) { return skin(pose.point({x, -kBehind_mm, z}), beam, kSearch_mm); };
  const auto middle = below(0, 0);
  if (!middle) return std::nullopt;
  // Beyond an outline the line goes on to other skin, which does not belong to this slope.
  const auto beside = [&](double x, double z) {
    const auto met = below(x, z);
    return met && std::abs(glm::dot(*met - *middle, beam)) < kSteepest_mm ? *met : *middle;
  };
  const glm::dvec3 along_x = beside(kSlope_mm, 0) - beside(-kSlope_mm, 0);
  const glm::dvec3 along_z = beside(0, kSlope_mm) - beside(0, -kSlope_mm);
  const glm::dvec3 normal = glm::cross(along_z, along_x);
  const double length = glm::length(normal);
  return Contact{*middle, length > 1e-6 ? normal / length : beam};
}

Pose ProbeHand::settle(const Pose& from, const Contact& old, const Contact& reached) {
  const double pressed = glm::dot(from.translation - old.point, from.rotation[1]);
  Pose to{orthonormal(turn_between(old.inward, reached.inward) * from.rotation), reached.point};
  to.translation += pressed * to.rotation[1];
  return to;
}

std::optional<Pose> ProbeHand::slide(const Pose& from, const glm::dvec2& mm) const {
  const Pose aside{from.rotation, from.point({mm.x, 0, mm.y})};
  const auto old = contact(from), reached = contact(aside);
  if (!old) return aside;
  if (!reached) return std::nullopt;
  return settle(from, *old, *reached);
}

glm::dvec2 ProbeHand::slide_in_patient(const Pose& from, const glm::dvec2& mm) {
  constexpr double kLeastSine = 0.3;  // of the angle between beam and body's axis: 17 degrees
  const glm::dvec3 left(1, 0, 0), head(0, 0, 1), beam = from.rotation[1];
  glm::dvec3 around = glm::cross(beam, head), up(0);
  if (const double sine = glm::length(around); sine > kLeastSine) {
    around /= sine;
    up = glm::cross(around, beam);  // the direction of `head` along the face
  } else {
    around = glm::normalize(left - glm::dot(left, beam) * beam);
  }
  const glm::dvec3 moved = mm.x * around + mm.y * up;
  return {glm::dot(moved, from.rotation[0]), glm::dot(moved, from.rotation[2])};
}

Pose ProbeHand::press(const Pose& from, double mm) const {
  if (const auto here = contact(from)) {
    const double pressed = glm::dot(from.translation - here->point, from.rotation[1]);
    mm = std::clamp(pressed + mm, std::min(-kFarthest_mm, pressed), std::max(kDeepest_mm, pressed)) - pressed;
  }
  return {from.rotation, from.point({0, mm, 0})};
}

Pose ProbeHand::turn(const Pose& from, double tilt_deg, double rotation_deg, double rock_deg) {
  const glm::dvec3 angles = glm::radians(glm::dvec3(tilt_deg, rotation_deg, rock_deg));
  const double angle = glm::length(angles);
  if (angle <= 0) return from;
  return {orthonormal(from.rotation * glm::mat3_cast(glm::angleAxis(angle, angles / angle))), from.translation};
}

std::optional<Pose> ProbeHand::put(const Pose& from, const glm::dvec3& eye, const glm::dvec3& direction) const {
  constexpr double kSight_mm = 3000;
  const auto met = skin(eye, direction, kSight_mm);
  if (!met) return std::nullopt;
  // The slope is measured along a first estimate of the normal, because both the beam and the line of sight may run
  // along the skin, and then along the normal.
  Pose looking{turn_between(from.rotation[1], inward(*met).value_or(direction)) * from.rotation, *met};
  auto reached = contact(looking);
  if (!reached) return std::nullopt;
  looking = {turn_between(looking.rotation[1], reached->inward) * looking.rotation, reached->point};
  if (const auto closer = contact(looking)) reached = closer;
  const auto old = contact(from);
  if (!old || glm::dot(old->inward, from.rotation[1]) < kLeastFacing) return Pose{looking.rotation, reached->point};
  Pose to = settle(from, *old, *reached);
  const double pressed = glm::dot(to.translation - reached->point, to.rotation[1]);
  to.translation += std::max(-pressed, 0.0) * to.rotation[1];  // a lifted probe is put onto the skin
  return to;
}

}  // namespace insonate
