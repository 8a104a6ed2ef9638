#include "sim/probe/sweep.h"

#include <glm/common.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <limits>

namespace insonate {

std::vector<Pose> swept_planes(const Pose& patient_from_probe, int planes, double sweep_deg, double pivot_mm) {
  std::vector<Pose> placed;
  for (int k = 0; k < planes; ++k) {
    const double tilt = glm::radians(sweep_deg) * (double(k) / (planes - 1) - 0.5);
    const double c = std::cos(tilt), s = std::sin(tilt);
    const Pose probe_from_plane{glm::dmat3({1, 0, 0}, {0, c, s}, {0, -s, c}), pivot_mm * glm::dvec3(0, c - 1, s)};
    placed.push_back(patient_from_probe * probe_from_plane);
  }
  return placed;
}

std::optional<std::size_t> reversal_index(const Sweep& sweep) {
  constexpr double kResting_mm = 0.05;
  const glm::dvec3 middle(0, sweep.depth_mm / 2, 0);
  double way = 0;  // last step of the planes that moved, along their z
  for (std::size_t k = 1; k < sweep.patient_from_plane.size(); ++k) {
    const Pose before_from_patient = sweep.patient_from_plane[k - 1].inverse();
    const double step_mm = before_from_patient.point(sweep.patient_from_plane[k].point(middle)).z;
    if (std::abs(step_mm) < kResting_mm) continue;
    if (way * step_mm < 0) return k;
    way = step_mm;
  }
  return std::nullopt;
}

ScanLines scan_lines(const Sweep& sweep, int samples) {
  const ScanLines plane = scan_lines(sweep.probe, sweep.depth_mm, samples);
  ScanLines all = plane;
  all.lines.clear();
  for (const Pose& pose : sweep.patient_from_plane)
    for (const ScanLine& line : plane.lines)
      all.lines.push_back({pose.point(line.start), pose.direction(line.direction)});
  return all;
}

std::optional<SweepPosition> sweep_position(const Sweep& sweep, const glm::dvec3& patient_mm) {
  const int planes = int(sweep.patient_from_plane.size());
  const auto in_plane = [&](int k) { return sweep.patient_from_plane[std::size_t(k)].inverse().point(patient_mm); };
  glm::dvec3 here = in_plane(0);
  for (int k = 0; k + 1 < planes; ++k) {
    const glm::dvec3 next = in_plane(k + 1);
    if (here.z * next.z <= 0) {
      const double apart = std::abs(here.z) + std::abs(next.z);
      const auto in_this = line_position(sweep.probe, sweep.depth_mm, glm::dvec2(here));
      const auto in_next = line_position(sweep.probe, sweep.depth_mm, glm::dvec2(next));
      if (!in_this || !in_next) return std::nullopt;
      return SweepPosition{k, apart > 0 ? std::abs(here.z) / apart : 0, *in_this, *in_next};
    }
    here = next;
  }
  return std::nullopt;
}

Grid sweep_grid(const Sweep& sweep, double voxel_mm) {
  const Pose& middle = sweep.patient_from_plane[sweep.patient_from_plane.size() / 2];
  const Pose middle_from_patient = middle.inverse();
  glm::dvec3 low(std::numeric_limits<double>::max()), high = -low;
  for (const ScanLine& line : scan_lines(sweep, 1).lines)
    for (const glm::dvec3& p : {line.start, line.start + sweep.depth_mm * line.direction}) {
      low = glm::min(low, middle_from_patient.point(p));
      high = glm::max(high, middle_from_patient.point(p));
    }
  Grid grid;
  // One extra voxel at each side, for the fan's edges beyond its outer lines.
  grid.size = glm::ivec3(glm::ceil((high - low) / voxel_mm)) + 3;
  grid.spacing = glm::dvec3(voxel_mm);
  grid.direction = middle.rotation;
  grid.origin = middle.point((low + high) / 2.0 - voxel_mm * (glm::dvec3(grid.size) - 1.0) / 2.0);
  return grid;
}

}  // namespace insonate
