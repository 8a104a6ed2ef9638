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
  const glm::dvec3 lateral = turn[0], beam = turn[1], elevation = turn[2];  // of the reference, in the probe's frame
  // If the beams point to opposite sides, the probe tilts past 90 degrees, which turns its elevation axis over.
  const double side = beam.y < 0 ? -1 : 1;
  const double rotation = std::atan2(side * elevation.x, side * elevation.z);
  const double tilt = std::atan2(-elevation.y, side * std::hypot(elevation.x, elevation.z));
  // The probe's lateral axis and beam once it is rotated and tilted: what is left is rock.
  const glm::dvec3 rotated(std::cos(rotation), 0, -std::sin(rotation));
  const glm::dvec3 tilted(std::sin(tilt) * std::sin(rotation), std::cos(tilt), std::sin(tilt) * std::cos(rotation));
  GuidingMove move;
  move.rotation_deg = glm::degrees(rotation);
  move.tilt_deg = glm::degrees(tilt);
  move.rock_deg = glm::degrees(std::atan2(glm::dot(lateral, tilted), glm::dot(lateral, rotated)));
  const glm::dvec3 way = reference.translation - patient_from_probe.translation, axis = reference.rotation[1];
  move.slide_mm = way - glm::dot(way, axis) * axis;
  return move;
}

std::vector<std::string> in_words(const GuidingMove& move, const Pose& patient_from_probe,
                                  const GuidingLimits& limits) {
  std::vector<std::string> sentences;
  const auto degrees = [](double value) { return fixed(std::abs(value), 0) + "\u00b0"; };
  if (const double slide = glm::length(move.slide_mm); slide > limits.slide_mm)
    sentences.push_back("Slide " + fixed(slide, 0) + " mm towards " + direction_words(move.slide_mm) + ".");
  if (std::abs(move.rotation_deg) > limits.turn_deg)
    sentences.push_back("Rotate " + degrees(move.rotation_deg) +
                        (move.rotation_deg > 0 ? " clockwise." : " counter-clockwise."));
  if (std::abs(move.tilt_deg) > limits.turn_deg) {
    const double rotation = glm::radians(move.rotation_deg);
    const glm::dvec3 elevation = patient_from_probe.rotation * glm::dvec3(std::sin(rotation), 0, std::cos(rotation));
    const glm::dvec3 towards = elevation * (move.tilt_deg > 0 ? 1.0 : -1.0);
    sentences.push_back("Tilt " + degrees(move.tilt_deg) + ", the beam towards " + direction_words(towards) + ".");
  }
  if (std::abs(move.rock_deg) > limits.turn_deg)
    sentences.push_back("Rock " + degrees(move.rock_deg) + ", the beam " +
                        (move.rock_deg > 0 ? "away from the marker." : "towards the marker."));
  return sentences;
}

}  // namespace insonate
