#include "app/session/probe_hand.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

#include "sim/tissue/acoustic_volume.h"
#include "sim/tissue/skin_contact.h"

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
const double kMinFacing = std::cos(glm::radians(ProbeHand::kMostTilted_deg));

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

/// A place along the axis from feet to head.
struct Slice {
  double number;  ///< whole numbers are the slices' middles
  double last;    ///< the last slice's number
  bool in_ct() const { return number >= 0 && number <= last; }
};
Slice slice_of(const Volume<std::int16_t>& ct, const glm::dvec3& point) {
  const int along = feet_head_axis(ct.grid);
  return {ct.grid.index_from_patient(point)[along], double(ct.grid.size[along] - 1)};
}

/// Returns whether a point lies where the CT's end absorbs sound: a picture there is dark.
bool in_end(const Volume<std::int16_t>& ct, const glm::dvec3& point) {
  return to_end_mm(ct.grid, point) < end_slices(ct.grid) * ct.grid.spacing[feet_head_axis(ct.grid)];
}

/// Returns whether a slide leads into an end of the CT, or farther towards it.
bool enters_end(const Volume<std::int16_t>& ct, const glm::dvec3& from, const glm::dvec3& to) {
  return in_end(ct, to) && to_end_mm(ct.grid, to) < to_end_mm(ct.grid, from);
}

/// Returns whether there is body in every direction across the axis from feet to head: the point lies in the body or in
/// air inside it, such as a lung's.
bool encloses(const Volume<std::int16_t>& ct, const glm::dvec3& point) {
  constexpr int kDirections = 16;
  constexpr double kWidest_mm = 600;
  const glm::dmat3& axes = ct.grid.direction;
  const int along = feet_head_axis(ct.grid);
  for (int i = 0; i < kDirections; ++i) {
    const double angle = glm::two_pi<double>() * i / kDirections;
    const glm::dvec3 across = std::cos(angle) * axes[(along + 1) % 3] + std::sin(angle) * axes[(along + 2) % 3];
    if (!distance_to_skin(ct, point, across, kWidest_mm)) return false;
  }
  return true;
}

/// Returns roughly the direction from a point of the skin into the body, unit, by where there is body around the point.
/// Beyond the CT nothing is known, so directions that lead there do not count. Empty if there is as much body on every
/// side.
std::optional<glm::dvec3> towards_body(const Volume<std::int16_t>& ct, const glm::dvec3& point) {
  constexpr int kSteps = 3;
  constexpr double kStep_mm = kSlope_mm / kSteps;
  const auto in_ct = [&](const glm::dvec3& p) { return slice_of(ct, p).in_ct(); };
  const auto body = [&](const glm::dvec3& p) { return distance_to_skin(ct, p, {0, 1, 0}, 0).has_value(); };
  glm::dvec3 sum(0);
  for (int k = -kSteps; k <= kSteps; ++k)
    for (int j = -kSteps; j <= kSteps; ++j)
      for (int i = -kSteps; i <= kSteps; ++i) {
        const glm::dvec3 aside = kStep_mm * glm::dvec3(i, j, k);
        if (glm::length(aside) > kSlope_mm || !in_ct(point + aside) || !in_ct(point - aside)) continue;
        if (body(point + aside) && !body(point - aside)) sum += aside;
      }
  const double length = glm::length(sum);
  if (length < kStep_mm) return std::nullopt;
  return sum / length;
}

}  // namespace

/// Returns where a line meets the skin. Empty if it starts inside the body, because something else blocks it then, or
/// comes through a cut face of the CT, also where the cut goes through a lung.
std::optional<glm::dvec3> ProbeHand::skin(const glm::dvec3& from, const glm::dvec3& direction,
                                          double farthest_mm) const {
  const auto distance = distance_to_skin(*ct_, from, direction, farthest_mm);
  if (!distance || *distance <= 0) return std::nullopt;
  const glm::dvec3 met = from + *distance * direction;
  const Slice end = slice_of(*ct_, met), start = slice_of(*ct_, from);
  if (end.number < kCut_slices || end.number > end.last - kCut_slices) return std::nullopt;
  const double cut = start.number < 0 ? 0 : start.last;
  const double way = (cut - start.number) / (end.number - start.number);
  if (!start.in_ct() && encloses(*ct_, glm::mix(from, met, way))) return std::nullopt;
  return met;
}

/// Returns the skin's normal at a point of it, unit. It depends on the point alone, so that a probe that is moved to
/// and fro keeps its angle. Empty if it cannot be found.
std::optional<glm::dvec3> ProbeHand::inward(const glm::dvec3& point) const {
  constexpr int kRounds = 2;  // the first one measures along a rough direction
  std::optional<glm::dvec3> normal = towards_body(*ct_, point);
  for (int round = 0; normal && round < kRounds; ++round) {
    const glm::dmat3& axes = ct_->grid.direction;
    const int along = feet_head_axis(ct_->grid);
    const glm::dvec3 axis = axes[std::abs(glm::dot(*normal, axes[along])) < 0.9 ? along : (along + 1) % 3];
    const glm::dvec3 x = kSlope_mm * glm::normalize(glm::cross(*normal, axis)), z = glm::cross(x, *normal);
    // Beyond an outline the line goes on to other skin, which does not belong to this slope.
    const auto beside = [&](const glm::dvec3& aside) {
      const auto met = skin(point + aside - kBehind_mm * *normal, *normal, kSearch_mm);
      return met && std::abs(glm::dot(*met - point, *normal)) < kSteepest_mm ? *met : point;
    };
    const glm::dvec3 across = glm::cross(beside(z) - beside(-z), beside(x) - beside(-x));
    const double length = glm::length(across);
    if (length > 1e-6) normal = across / length;
  }
  return normal;
}

std::optional<ProbeHand::Contact> ProbeHand::contact(const Pose& pose) const {
  const auto point = skin(pose.point({0, -kBehind_mm, 0}), pose.rotation[1], kSearch_mm);
  if (!point) return std::nullopt;
  return Contact{*point, inward(*point).value_or(pose.rotation[1])};
}

/// Returns the skin's normal over the face. Where the beam of a probe that is tilted and pressed enters the skin, the
/// skin has another one.
std::optional<glm::dvec3> ProbeHand::inward_at_face(const Pose& pose) const {
  const auto here = contact(pose);
  if (!here) return std::nullopt;
  const auto over_face = skin(pose.translation - kBehind_mm * here->inward, here->inward, kSearch_mm);
  return over_face ? inward(*over_face) : here->inward;
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
  if (!reached || enters_end(*ct_, old->point, reached->point)) return std::nullopt;
  return settle(from, *old, *reached);
}

std::optional<ProbeHand::Slide> ProbeHand::slide_to(const Pose& from, const Pose& to) const {
  const auto old = contact(from), reached = contact(to);
  if (!old || !reached || enters_end(*ct_, old->point, reached->point)) return std::nullopt;
  return Slide{settle(from, *old, *reached), reached->point - old->point};
}

glm::dvec2 ProbeHand::slide_in_patient(const Pose& from, const glm::dvec2& mm) {
  constexpr double kMinSine = 0.3;  // of the angle between beam and body's axis: 17 degrees
  const glm::dvec3 left(1, 0, 0), head(0, 0, 1), beam = from.rotation[1];
  glm::dvec3 around = glm::cross(beam, head), up(0);
  if (const double sine = glm::length(around); sine > kMinSine) {
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

std::optional<Pose> ProbeHand::turn_on_skin(const Pose& from, double tilt_deg, double rotation_deg,
                                            double rock_deg) const {
  constexpr double kRounding = 1e-9, kLeast_deg = 0.1;
  const std::optional<glm::dvec3> into_skin = inward_at_face(from);
  if (!into_skin) return turn(from, tilt_deg, rotation_deg, rock_deg);
  const double before = glm::dot(*into_skin, from.rotation[1]);
  for (double share = 1;; share /= 2) {
    const bool lays_down = share * std::hypot(tilt_deg, rock_deg) > kLeast_deg;
    if (!lays_down) share = 0;
    const Pose to = turn(from, share * tilt_deg, rotation_deg, share * rock_deg);
    const double after = glm::dot(*into_skin, to.rotation[1]);
    if (after >= kMinFacing || after >= before - kRounding) return to == from ? std::nullopt : std::optional(to);
    if (!lays_down) return std::nullopt;
  }
}

std::optional<Pose> ProbeHand::put(const Pose& from, const glm::dvec3& eye, const glm::dvec3& direction) const {
  constexpr double kSight_mm = 3000;
  const auto met = skin(eye, direction, kSight_mm);
  if (!met || in_end(*ct_, *met)) return std::nullopt;
  const glm::dvec3 normal = inward(*met).value_or(direction);
  const auto old = contact(from);
  if (!old || glm::dot(old->inward, from.rotation[1]) < kMinFacing)
    return Pose{orthonormal(turn_between(from.rotation[1], normal) * from.rotation), *met};
  Pose to = settle(from, *old, {*met, normal});
  const double pressed = glm::dot(to.translation - *met, to.rotation[1]);
  to.translation += std::max(-pressed, 0.0) * to.rotation[1];  // a lifted probe is put onto the skin
  return to;
}

}  // namespace insonate
