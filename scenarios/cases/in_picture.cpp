#include "scenarios/cases/in_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scenarios/metrics/view_meter.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

/// Returns the number of sampled points of the fan in each label.
std::array<long, 256> places_of_labels(const Case& subject, const Probe& probe, double depth_mm,
                                       const Pose& patient_from_probe) {
  std::array<long, 256> places{};
  if (subject.labels.empty()) return places;
  const Grid& grid = subject.labels.grid;
  const glm::dvec2 edge = face_edge(probe);
  const double reach_mm = std::abs(edge.x) + depth_mm;
  for (double y = std::min(0.0, edge.y); y <= depth_mm; y += kLookedAt_mm)
    for (double x = -reach_mm; x <= reach_mm; x += kLookedAt_mm) {
      if (!line_position(probe, depth_mm, {x, y})) continue;
      const glm::dvec3 p = patient_from_probe.point({x, y, 0});
      ++places[sample_nearest(subject.labels, grid.index_from_patient(p))];
    }
  return places;
}

}  // namespace

InPicture in_picture(const Case& subject, const Probe& probe, double depth_mm, const Pose& patient_from_probe) {
  const std::array<long, 256> places = places_of_labels(subject, probe, depth_mm, patient_from_probe);
  std::vector<Label> seen;
  for (const Label& label : subject.label_table)
    if (places[label.value] > 0) seen.push_back(label);
  std::stable_sort(seen.begin(), seen.end(),
                   [&](const Label& a, const Label& b) { return places[a.value] > places[b.value]; });
  InPicture found;
  for (const Label& label : seen) found.structures.push_back(label.name);
  for (const Landmark& landmark : subject.landmarks)
    if (why_not_in_picture(landmark, probe, depth_mm, patient_from_probe).empty())
      found.landmarks.push_back(landmark.name);
  return found;
}

std::string why_not_in_picture(const Landmark& landmark, const Probe& probe, double depth_mm,
                               const Pose& patient_from_probe) {
  const glm::dvec3 p = patient_from_probe.inverse().point(landmark.position);
  if (std::abs(p.z) > ViewMeter::kLandmarkDistance_mm) {
    return formatted("lies %.0f mm beside its plane", std::abs(p.z));
  }
  return line_position(probe, depth_mm, glm::dvec2(p)) ? "" : "lies outside its fan";
}

}  // namespace insonate
