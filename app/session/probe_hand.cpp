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
constexpr double kReach_mm = 120;
/// The skin's slope is taken over about the width of a face, so that ribs and the navel do not tilt the probe.
constexpr double kSlope_mm = 18;

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

std::optional<ProbeHand::Contact> ProbeHand::contact(const Pose& pose) const {
  const glm::dvec3 beam = pose.rotation[1];
  const auto skin = [&](double x, double z) -> std::optional<glm::dvec3> {
    const glm::dvec3 from = pose.point({x, -kBehind_mm, z});
    const auto distance = distance_to_skin(*ct_, from, beam, kReach_mm);
    // A start inside the body means that something else blocks the line.
    if (!distance || *distance <= 0) return std::nullopt;
    return from + *distance * beam;
  };
  const auto middle = skin(0, 0);
  if (!middle) return std::nullopt;
  const auto left = skin(-kSlope_mm, 0), right = skin(kSlope_mm, 0);
  const auto near = skin(0, -kSlope_mm), far = skin(0, kSlope_mm);
  const glm::dvec3 along_x = right.value_or(*middle) - left.value_or(*middle);
  const glm::dvec3 along_z = far.value_or(*middle) - near.value_or(*middle);
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

Pose ProbeHand::slide(const Pose& from, const glm::dvec2& mm) const {
  const Pose aside{from.rotation, from.point({mm.x, 0, mm.y})};
  const auto old = contact(from), reached = contact(aside);
  if (!old) return aside;
  return reached ? settle(from, *old, *reached) : from;
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

Pose ProbeHand::put(const Pose& from, const glm::dvec3& eye, const glm::dvec3& direction) const {
  constexpr double kSight_mm = 3000;
  const auto distance = distance_to_skin(*ct_, eye, direction, kSight_mm);
  const auto old = contact(from);
  if (!distance || !old) return from;
  // The slope is measured along the line of sight, because the beam may run along the skin.
  const Pose looking{turn_between(from.rotation[1], direction) * from.rotation, eye + *distance * direction};
  const auto reached = contact(looking);
  return reached ? settle(from, *old, *reached) : from;
}

}  // namespace insonate
