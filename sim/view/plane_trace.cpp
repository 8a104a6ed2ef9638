#include "sim/view/plane_trace.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace insonate::view {
namespace {

/// Returns the part of the line through `at` along `direction` that lies in a picture; empty if it misses the picture.
std::optional<PixelLine> clipped(const glm::dvec2& at, const glm::dvec2& direction, const glm::dvec2& size) {
  double from = -1e9, to = 1e9;
  for (int i = 0; i < 2; ++i) {
    if (std::abs(direction[i]) < 1e-12) {
      if (at[i] < 0 || at[i] > size[i]) return std::nullopt;
      continue;
    }
    const double a = -at[i] / direction[i], b = (size[i] - at[i]) / direction[i];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  if (from >= to) return std::nullopt;
  return PixelLine{at + from * direction, at + to * direction};
}

}  // namespace

std::vector<glm::dvec2> fan_outline(const Probe& probe, double depth_mm, int lines) {
  // A scan line runs in the middle of its share of the fan, so the first and the last are at the fan's edges only where
  // there are many.
  constexpr int kFiner = 32;
  Probe sampled = probe;
  sampled.lines = kFiner * (lines - 1) + 1;
  const ScanLines fan = scan_lines(sampled, depth_mm, 1);
  std::vector<glm::dvec2> outline, far_end;
  for (std::size_t i = 0; i < fan.lines.size(); i += kFiner) {
    const ScanLine& line = fan.lines[i];
    outline.emplace_back(line.start);
    far_end.emplace_back(line.start + fan.r_max_mm * line.direction);
  }
  outline.insert(outline.end(), far_end.rbegin(), far_end.rend());
  return outline;
}

PlaneTrace trace_of_plane(const AxisSlice& slice, const Pose& patient_from_probe, const Probe& probe, double depth_mm) {
  const Pose picture_from_probe = slice.patient_from_picture().inverse() * patient_from_probe;
  const glm::dvec3 normal = picture_from_probe.rotation[2];  // of the ultrasound's plane, in the picture's frame
  std::vector<glm::dvec3> fan;
  for (const glm::dvec2& point : fan_outline(probe, depth_mm)) fan.push_back(picture_from_probe.point({point, 0}));
  const auto pixel = [&](const glm::dvec2& mm) {
    return mm / slice.mm_per_pixel + glm::dvec2(slice.width, slice.height) / 2.0;
  };

  PlaneTrace trace;
  if (std::abs(normal.z) > std::cos(glm::radians(kSamePlane_deg))) {
    if (std::abs(picture_from_probe.point({0, depth_mm / 2, 0}).z) > kSamePlane_mm) return trace;
    for (const glm::dvec3& point : fan) trace.outline.push_back(pixel(point));
    return trace;
  }
  // In the picture (z = 0) the ultrasound's plane is across . p = offset.
  const glm::dvec2 across(normal);
  const glm::dvec2 foot = across * (glm::dot(normal, picture_from_probe.translation) / glm::dot(across, across));
  const glm::dvec2 along = glm::normalize(glm::dvec2(-across.y, across.x));
  trace.line = clipped(pixel(foot), along, glm::dvec2(slice.width, slice.height));

  std::vector<double> crossings;  // mm along the line
  for (std::size_t i = 0; i < fan.size(); ++i) {
    const glm::dvec3 &a = fan[i], &b = fan[(i + 1) % fan.size()];
    if ((a.z < 0) == (b.z < 0)) continue;
    crossings.push_back(glm::dot(glm::dvec2(glm::mix(a, b, a.z / (a.z - b.z))) - foot, along));
  }
  std::sort(crossings.begin(), crossings.end());
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
    trace.in_fan.push_back({pixel(foot + crossings[i] * along), pixel(foot + crossings[i + 1] * along)});
  return trace;
}

}  // namespace insonate::view
