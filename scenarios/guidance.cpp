#include "scenarios/guidance.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include "scenarios/words.h"

namespace insonate {
namespace {

/// Returns the patient direction (LPS) that a vector points to: its largest component, and a second one if it is at
/// least half as large.
std::string direction_words(const glm::dvec3& direction) {
  static constexpr std::array<std::array<const char*, 2>, 3> kWays{
      {{"the patient's left", "the patient's right"}, {"the back", "the front"}, {"the head", "the feet"}}};
  std::array<int, 3> axes{0, 1, 2};
  std::sort(axes.begin(), axes.end(), [&](int a, int b) { return std::abs(direction[a]) > std::abs(direction[b]); });
  const auto way = [&](int axis) { return std::string(kWays[std::size_t(axis)][direction[axis] < 0]); };
  std::string words = way(axes[0]);
  if (std::abs(direction[axes[1]]) >= std::abs(direction[axes[0]]) / 2) words += " and " + way(axes[1]);
  return words;
}

}  // namespace

GuidingMove move_to(const Pose& patient_from_probe, const Pose& reference) {
  const glm::dmat3 turn = glm::transpose(patient_from_probe.rotation) * reference.rotation;
  const glm::dvec3 beam = turn[1];  // beam of the reference, in the probe's frame
  GuidingMove move;
  move.rock_deg = glm::degrees(std::asin(std::clamp(-beam.x, -1.0, 1.0)));
  move.tilt_deg = glm::degrees(std::atan2(beam.z, beam.y));
  // Without tilt and rock, the remaining rotation is about the beam only.
  const double a = std::atan2(beam.z, beam.y), b = glm::radians(move.rock_deg);
  const glm::dvec3 lateral(std::cos(b), std::cos(a) * std::sin(b), std::sin(a) * std::sin(b));
  const glm::dvec3 elevation(0, -std::sin(a), std::cos(a));
  move.rotation_deg = glm::degrees(std::atan2(-glm::dot(turn[0], elevation), glm::dot(turn[0], lateral)));
  const glm::dvec3 way = reference.translation - patient_from_probe.translation, axis = patient_from_probe.rotation[1];
  move.slide_mm = way - glm::dot(way, axis) * axis;
  return move;
}

std::vector<std::string> in_words(const GuidingMove& move, const Pose& patient_from_probe) {
  std::vector<std::string> sentences;
  const auto degrees = [](double value) { return fixed(std::abs(value), 0) + "\u00b0"; };
  if (const double slide = glm::length(move.slide_mm); slide > kGuidedSlide_mm)
    sentences.push_back("Slide " + fixed(slide, 0) + " mm towards " + direction_words(move.slide_mm) + ".");
  if (std::abs(move.rotation_deg) > kGuidedTurn_deg)
    sentences.push_back("Rotate " + degrees(move.rotation_deg) +
                        (move.rotation_deg > 0 ? " clockwise." : " counter-clockwise."));
  if (std::abs(move.tilt_deg) > kGuidedTurn_deg) {
    const glm::dvec3 towards = patient_from_probe.rotation[2] * (move.tilt_deg > 0 ? 1.0 : -1.0);
    sentences.push_back("Tilt " + degrees(move.tilt_deg) + ", the beam towards " + direction_words(towards) + ".");
  }
  if (std::abs(move.rock_deg) > kGuidedTurn_deg)
    sentences.push_back("Rock " + degrees(move.rock_deg) + ", the beam " +
                        (move.rock_deg > 0 ? "away from the marker." : "towards the marker."));
  return sentences;
}

}  // namespace insonate
