#include "devices/calibration/axes.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

namespace insonate {
namespace {

constexpr double kNever_deg = 180;
/// Tolerance for the straightness and the right angles of moves by hand.
constexpr double kMaxOffSquare_deg = 35;
/// Among combinations within this of the best misfit, the one with the fewest sign changes is chosen.
constexpr double kAsGood_deg = 8;

double angle_deg(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::degrees(std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)));
}

glm::dvec3 way(const StraightMove& move, const AxisSigns& signs) {
  return signs.position * (move.to.translation - move.from.translation);
}

/// Converts a direction from the tracker's frame to the probe's at the start of a move.
glm::dvec3 seen(const StraightMove& move, const AxisSigns& signs, const glm::dvec3& direction) {
  return glm::transpose(signs.apply(move.from).rotation) * direction;
}

double misfit_deg(const AxesMoves& moves, const AxisSigns& signs) {
  const glm::dvec3 right = way(moves.right, signs), up = way(moves.up, signs), head = way(moves.to_head, signs);
  if (glm::dot(glm::cross(right, up), head) <= 0) return kNever_deg;
  const glm::dvec3 marker = seen(moves.right, signs, right);
  return std::max({angle_deg(marker, seen(moves.to_head, signs, head)),
                   angle_deg(marker, seen(moves.lying, signs, way(moves.lying, signs))),
                   angle_deg(seen(moves.right, signs, up), seen(moves.to_head, signs, up))});
}

std::vector<AxisSigns> possibilities() {
  std::vector<AxisSigns> all;
  for (const glm::dvec3& position :
       {glm::dvec3(1), glm::dvec3(-1, 1, 1), glm::dvec3(1, -1, 1), glm::dvec3(1, 1, -1), glm::dvec3(-1)})
    for (int bits = 0; bits < 8; ++bits)
      all.push_back({position, {bits & 1 ? -1 : 1, bits & 2 ? -1 : 1, bits & 4 ? -1 : 1}});
  return all;
}

int changes(const AxisSigns& signs) {
  int count = 0;
  for (int axis = 0; axis < 3; ++axis) count += (signs.position[axis] < 0) + (signs.quaternion[axis] < 0);
  return count;
}

std::optional<Refusal> why_unusable(const AxesMoves& moves) {
  char text[200];
  const std::pair<const char*, const StraightMove*> named[] = {{"to the right", &moves.right},
                                                               {"up", &moves.up},
                                                               {"to the head", &moves.to_head},
                                                               {"up with the marker up", &moves.lying}};
  for (const auto& [name, move] : named) {
    const double mm = glm::distance(move->from.translation, move->to.translation);
    if (mm >= kMinMove_mm) continue;
    std::snprintf(text, sizeof text, "The move %s was %.0f mm long; move 100 mm or more.", name, mm);
    return Refusal{text};
  }
  // Sign changes do not affect these angles.
  const AxisSigns as_they_are;
  const glm::dvec3 right = way(moves.right, as_they_are), up = way(moves.up, as_they_are),
                   head = way(moves.to_head, as_they_are), lying = way(moves.lying, as_they_are);
  const double worst = std::max({std::abs(90 - angle_deg(right, up)), std::abs(90 - angle_deg(up, head)),
                                 std::abs(90 - angle_deg(right, head)), angle_deg(up, lying)});
  if (worst <= kMaxOffSquare_deg) return std::nullopt;
  std::snprintf(
      text, sizeof text,
      "Right, up and to the head were not at right angles, by %.0f degrees; move straight along each and begin "
      "again.",
      worst);
  return Refusal{text};
}

void append(std::string& text, const char* what, const glm::dvec3& signs) {
  std::string axes;
  for (int axis = 0; axis < 3; ++axis)
    if (signs[axis] < 0) axes += (axes.empty() ? "" : ", ") + std::string(1, "xyz"[axis]);
  if (axes.empty()) return;
  if (const std::size_t comma = axes.rfind(", "); comma != std::string::npos) axes.replace(comma, 2, " and ");
  text += (text.empty() ? "" : "; ") + std::string(what) + " " + axes;
}

}  // namespace

Pose AxisSigns::apply(const Pose& pose) const {
  if (none()) return pose;
  const glm::dquat turn = glm::quat_cast(pose.rotation);
  return {quaternion == glm::dvec3(1)
              ? pose.rotation
              : glm::mat3_cast(glm::normalize(
                    glm::dquat(turn.w, quaternion.x * turn.x, quaternion.y * turn.y, quaternion.z * turn.z))),
          position * pose.translation};
}

std::string AxisSigns::words() const {
  std::string text;
  append(text, "the position's", position);
  append(text, "the quaternion's", quaternion);
  return text.empty() ? "no axis is mirrored" : "mirrored: " + text;
}

const std::array<AskedMove, 4>& asked_moves() {
  static const glm::dvec3 right(-1, 0, 0), up(0, -1, 0), head(0, 0, 1);
  static const std::array<AskedMove, 4> moves{
      {{right, -up, right}, {right, -up, up}, {head, -up, head}, {up, right, up}}};
  return moves;
}

Outcome<AxesFinding> check_axes(const AxesMoves& moves) {
  if (const auto refusal = why_unusable(moves)) return *refusal;
  const double as_it_is = misfit_deg(moves, {});
  if (as_it_is <= kMaxAxesMisfit_deg) return AxesFinding{{}, as_it_is};
  std::vector<AxesFinding> findings;
  for (const AxisSigns& signs : possibilities()) findings.push_back({signs, misfit_deg(moves, signs)});
  const auto by_misfit = [](const AxesFinding& a, const AxesFinding& b) { return a.misfit_deg < b.misfit_deg; };
  const double least = std::min_element(findings.begin(), findings.end(), by_misfit)->misfit_deg;
  if (least > kMaxAxesMisfit_deg) {
    char text[200];
    std::snprintf(
        text, sizeof text,
        "The probe's turns do not fit its moves, whatever axis is mirrored (%.0f degrees at best); hold it as is "
        "shown and begin again.",
        least);
    return Refusal{text};
  }
  std::erase_if(findings, [&](const AxesFinding& finding) { return finding.misfit_deg > least + kAsGood_deg; });
  return *std::min_element(findings.begin(), findings.end(), [](const AxesFinding& a, const AxesFinding& b) {
    return std::pair(changes(a.signs), a.misfit_deg) < std::pair(changes(b.signs), b.misfit_deg);
  });
}

}  // namespace insonate
