#include "sim/probe/probe.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace insonate {
namespace {

// Returns the angle of a line from the central beam: -fov/2 to fov/2 for `across` from 0 to 1 over the field of view.
double angle_at(const Probe& probe, double across) {
  return glm::radians(probe.field_of_view_deg) * (across - 0.5);
}

LineFan line_fan(const Probe& probe) {
  using Face = LineFan::Face;
  if (probe.kind == ProbeKind::linear) {
    const double step = probe.width_mm / probe.lines;
    return {Face::parallel, 0, (step - probe.width_mm) / 2, step};
  }
  const double view = glm::radians(probe.field_of_view_deg), step = view / probe.lines;
  return {probe.kind == ProbeKind::phased ? Face::flat : Face::round, apex_behind_mm(probe), (step - view) / 2, step};
}

struct Extent {
  glm::dvec2 low, high;  // mm in the imaging plane
};

Extent fan_extent(const Probe& probe, double depth_mm) {
  if (probe.kind == ProbeKind::linear) return {{-probe.width_mm / 2, 0}, {probe.width_mm / 2, depth_mm}};
  const double half = glm::radians(probe.field_of_view_deg) / 2;
  if (probe.kind == ProbeKind::phased) {
    const double half_width = probe.width_mm / 2 + depth_mm * std::sin(half);
    return {{-half_width, 0}, {half_width, depth_mm}};
  }
  const double reach = probe.radius_mm + depth_mm;
  // Beyond 180 degrees the fan is widest at its equator, not at its deep corners.
  const double half_width = reach * std::sin(std::min(half, glm::radians(90.0)));
  const double top = std::min(probe.radius_mm * std::cos(half), reach * std::cos(half)) - probe.radius_mm;
  return {{-half_width, top}, {half_width, depth_mm}};
}

}  // namespace

const std::vector<Probe>& probes() {
  static const std::vector<Probe> all = [] {
    // Like common abdominal arrays: 60 mm radius, 60 degrees, 2 to 5 MHz. The aperture is that by which beams of the
    // C5-2v widen with depth (docs/speckle.md).
    Probe curvilinear;
    curvilinear.name = "curvilinear";
    curvilinear.title = "Curvilinear";
    Probe linear;  // like common vascular arrays: 38 to 40 mm, 5 to 10 MHz
    linear.name = "linear";
    linear.title = "Linear";
    linear.kind = ProbeKind::linear;
    linear.frequency_mhz = 7.5;
    linear.depth_mm = 50;
    linear.aperture_mm = linear.width_mm;
    Probe phased;  // like common cardiac arrays: about 20 mm, 90 degrees, 1 to 5 MHz
    phased.name = "phased";
    phased.title = "Phased";
    phased.kind = ProbeKind::phased;
    phased.width_mm = phased.aperture_mm = 20;
    phased.field_of_view_deg = 90;
    phased.frequency_mhz = 2.5;
    return std::vector<Probe>{curvilinear, linear, phased};
  }();
  return all;
}

const Probe* find_probe(std::string_view name) {
  const auto& all = probes();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Probe& probe) { return probe.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::vector<std::string> probe_names() {
  std::vector<std::string> names;
  for (const Probe& probe : probes()) names.push_back(probe.name);
  return names;
}

double apex_behind_mm(const Probe& probe) {
  if (probe.kind == ProbeKind::curvilinear) return probe.radius_mm;
  return probe.width_mm / 2 / std::tan(glm::radians(probe.field_of_view_deg) / 2);
}

glm::dvec2 face_edge(const Probe& probe) {
  if (probe.kind != ProbeKind::curvilinear) return {probe.width_mm / 2, 0};
  const double half = glm::radians(probe.field_of_view_deg) / 2;
  return probe.radius_mm * glm::dvec2(std::sin(half), std::cos(half) - 1);
}

ScanLines scan_lines(const Probe& probe, double depth_mm, int samples, double steering) {
  ScanLines set;
  set.samples = samples;
  set.r_max_mm = depth_mm;
  set.aperture_mm = probe.aperture_mm;
  set.fan = line_fan(probe);
  set.fan.steering = steering;
  const glm::dvec3 turned(std::sin(steering), std::cos(steering), 0);
  for (int i = 0; i < probe.lines; ++i) {
    const double across = (i + 0.5) / probe.lines;
    if (probe.kind == ProbeKind::linear) {
      set.lines.push_back({{probe.width_mm * (across - 0.5), 0, 0}, turned});
      continue;
    }
    const double angle = angle_at(probe, across);
    const glm::dvec3 direction(std::sin(angle), std::cos(angle), 0);
    const glm::dvec3 start = probe.kind == ProbeKind::phased
                                 ? glm::dvec3(apex_behind_mm(probe) * std::tan(angle), 0, 0)
                                 : glm::dvec3(0, -probe.radius_mm, 0) + probe.radius_mm * direction;
    const glm::dvec3 steered(std::sin(angle + steering), std::cos(angle + steering), 0);
    set.lines.push_back({start, steering == 0 ? direction : steered});
  }
  return set;
}

std::optional<LinePosition> line_position(const Probe& probe, double depth_mm, const glm::dvec2& xy_mm) {
  // So that of two pixels that lie on opposite edges, both are inside, however they were rounded.
  const double slack_mm = 1e-12 * (depth_mm + probe.radius_mm), slack = 1e-12;
  double across = 0, r = 0;
  if (probe.kind == ProbeKind::linear) {
    across = xy_mm.x / probe.width_mm + 0.5;
    r = xy_mm.y;
  } else {
    const bool phased = probe.kind == ProbeKind::phased;
    if (phased && xy_mm.y < -slack_mm) return std::nullopt;
    const double below_apex = xy_mm.y + apex_behind_mm(probe);
    const double from_apex = glm::length(glm::dvec2(xy_mm.x, below_apex));
    r = phased ? from_apex * xy_mm.y / below_apex : from_apex - probe.radius_mm;
    // Most pixels beside a fan end here, before the angle.
    if (r < -slack_mm || r > depth_mm + slack_mm) return std::nullopt;
    across = std::atan2(xy_mm.x, below_apex) / glm::radians(probe.field_of_view_deg) + 0.5;
  }
  if (across < -slack || across > 1 + slack || r < -slack_mm || r > depth_mm + slack_mm) return std::nullopt;
  return LinePosition{std::clamp(across, 0.0, 1.0) * probe.lines - 0.5, std::clamp(r, 0.0, depth_mm)};
}

LinePosition position_among(const LineFan& fan, const glm::dvec2& xy_mm) {
  const double sine = std::sin(fan.steering), cosine = std::cos(fan.steering);
  if (fan.face == LineFan::Face::parallel)
    return {(xy_mm.x - xy_mm.y * sine / cosine - fan.first) / fan.step, xy_mm.y / cosine};
  const double below_apex = xy_mm.y + fan.apex_mm, from_apex = std::hypot(xy_mm.x, below_apex);
  if (fan.steering != 0) {
    // A line that is turned by a touches the circle of radius R sin a about the apex, R the face's radius.
    const double to_tangent = std::max(from_apex * from_apex - std::pow(fan.apex_mm * sine, 2), 0.0);
    const double r = std::sqrt(to_tangent) - fan.apex_mm * cosine;
    const double behind_start = std::atan2(r * sine, fan.apex_mm + r * cosine);
    return {(std::atan2(xy_mm.x, below_apex) - behind_start - fan.first) / fan.step, r};
  }
  const double face = fan.face == LineFan::Face::flat ? std::max(below_apex / from_apex, std::cos(fan.first)) : 1;
  const double r = from_apex - fan.apex_mm / face;
  return {(std::atan2(xy_mm.x, below_apex) - fan.first) / fan.step, r};
}

std::optional<LinePosition> position_within(const ScanLines& lines, const glm::dvec2& xy_mm) {
  const LinePosition at = position_among(lines.fan, xy_mm);
  const double beyond_outer = 0.5;
  if (at.line < -beyond_outer || at.line > double(lines.lines.size()) - beyond_outer) return std::nullopt;
  if (at.r_mm < lines.r_min_mm || at.r_mm > lines.r_max_mm) return std::nullopt;
  return at;
}

ImageGeometry image_geometry(const Probe& probe, double depth_mm, int width, int height) {
  const Extent fan = fan_extent(probe, depth_mm);
  const glm::dvec2 size = fan.high - fan.low;
  ImageGeometry geometry;
  geometry.width = width;
  geometry.height = height;
  geometry.mm_per_pixel = std::max(size.x / width, size.y / height);
  const glm::dvec2 shown = geometry.mm_per_pixel * glm::dvec2(width, height);
  geometry.top_left_mm = (fan.low + fan.high - shown) / 2.0 + geometry.mm_per_pixel / 2;
  return geometry;
}

}  // namespace insonate
