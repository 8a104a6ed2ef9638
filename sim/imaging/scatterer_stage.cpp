#include "sim/imaging/scatterer_stage.h"

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sim/core/hash.h"
#include "sim/model/beam.h"
#include "sim/model/compounding.h"
#include "sim/model/waves.h"

namespace insonate::gl {
namespace {

constexpr double kLargestQuantum = 32000;  // of the 16 bits, with room for rounding
// The parts of a sum of many scatterers stay below six times its root mean square, 8.5 standard deviations. Those of a
// few scatterers stay below 6.
constexpr double kMaxRms = 6, kMaxOfFew = 6;

double quanta_of(const ScanLines& lines, const Settings& settings) {
  return kLargestQuantum / (kMaxRms * scatterer_rms(lines, settings) + kMaxOfFew);
}

double slice_half_mm(const ScanLines& lines, const Settings& settings) {
  const double dr = lines.dr_mm();
  return kSliceHalf * std::max(slice_thickness_at_mm(settings, lines.r_min_mm - dr),
                               slice_thickness_at_mm(settings, lines.r_max_mm + dr));
}

// Returns a point of the imaging plane among the lines.
glm::dvec2 point_among(const LineFan& fan, double line, double r_mm) {
  const double across = fan.first + line * fan.step;
  const glm::dvec2 turned(std::sin(fan.steering), std::cos(fan.steering));
  if (fan.face == LineFan::Face::parallel) return glm::dvec2(across, 0) + r_mm * turned;
  if (fan.steering != 0)
    return fan.apex_mm * glm::dvec2(std::sin(across), std::cos(across) - 1) +
           r_mm * glm::dvec2(std::sin(across + fan.steering), std::cos(across + fan.steering));
  const double face = fan.face == LineFan::Face::flat ? std::max(std::cos(across), std::cos(fan.first)) : 1;
  const double from_apex = r_mm + fan.apex_mm / face;
  return {from_apex * std::sin(across), from_apex * std::cos(across) - fan.apex_mm};
}

// Returns points whose convex hull holds all places from which a scatterer reaches a sample.
std::vector<glm::dvec2> outline(const ScanLines& lines) {
  constexpr int kParts = 32;
  const LineFan& fan = lines.fan;
  const bool parallel = fan.face == LineFan::Face::parallel;
  const double n = double(lines.lines.size()), dr = lines.dr_mm(), part = (n + 1) / kParts;
  const double nearest = lines.r_min_mm - dr, first = parallel ? nearest : std::max(nearest, -fan.apex_mm);
  std::vector<glm::dvec2> points;
  for (int i = 0; i <= kParts; ++i) {
    const double line = -1 + i * part;
    points.push_back(point_among(fan, line, first));
    // Between two points an arc lies farther out than their chord.
    const glm::dvec2 last = point_among(fan, line, lines.r_max_mm + dr), apex(0, -fan.apex_mm);
    points.push_back(parallel ? last : apex + (last - apex) / std::cos(part * fan.step / 2));
  }
  return points;
}

// Returns the corners of the convex hull in order (Andrew's monotone chain).
std::vector<glm::dvec2> convex_hull(std::vector<glm::dvec2> points) {
  std::ranges::sort(points,
                    [](const glm::dvec2& a, const glm::dvec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<glm::dvec2> hull;
  const auto turn = [](const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  };
  for (int side = 0; side < 2; ++side) {
    const std::size_t begin = hull.size();
    for (const glm::dvec2& point : points) {
      while (hull.size() >= begin + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0) hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

// Appends groups of columns for all cells of the plane that the hull touches.
void append_groups(std::vector<glm::ivec2>& groups, const std::vector<glm::dvec2>& hull) {
  constexpr double kRounding = 0.01;
  double low = hull.front().y, high = low;
  for (const glm::dvec2& corner : hull) low = std::min(low, corner.y), high = std::max(high, corner.y);
  for (int row = int(std::floor(low - kRounding)); row <= int(std::floor(high + kRounding)); ++row) {
    const double bottom = row - kRounding, top = row + 1 + kRounding;
    double left = std::numeric_limits<double>::infinity(), right = -left;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const glm::dvec2 a = hull[i], b = hull[(i + 1) % hull.size()];
      if (std::max(a.y, b.y) < bottom || std::min(a.y, b.y) > top) continue;
      for (const double y : {std::clamp(a.y, bottom, top), std::clamp(b.y, bottom, top)}) {
        const double x = a.y == b.y ? (y == a.y ? a.x : b.x) : a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
        left = std::min({left, x, a.y == b.y ? b.x : x});
        right = std::max({right, x, a.y == b.y ? b.x : x});
      }
    }
    const int last = int(std::floor(right + kRounding));
    for (int first = int(std::floor(left - kRounding)); first <= last; first += ScattererColumns::kGroup)
      groups.emplace_back(first, row);
  }
}

}  // namespace

ScattererColumns scatterer_columns(const Pose& patient_from_probe, const ScanLines& lines, const Settings& settings) {
  const glm::dmat4 cells_from_probe =
      cells_from_patient(scatterer_pitch_mm(lines, settings)) * patient_from_probe.matrix();
  const glm::dmat4 probe_from_cells = glm::inverse(cells_from_probe);
  const double half = slice_half_mm(lines, settings);

  int along = 0;  // the axis along which the slice is thinnest
  for (int axis : {1, 2})
    if (std::abs(probe_from_cells[axis].z) > std::abs(probe_from_cells[along].z)) along = axis;
  const int across = (along + 1) % 3, up = (along + 2) % 3;

  std::vector<glm::dvec3> corners;
  glm::dvec3 sum(0);
  for (const glm::dvec2& point : outline(lines))
    for (const double z : {-half, half}) {
      corners.emplace_back(cells_from_probe * glm::dvec4(point, z, 1));
      sum += corners.back();
    }
  const glm::ivec3 corner(glm::floor(sum / double(corners.size())));
  std::vector<glm::dvec2> projected;
  for (const glm::dvec3& point : corners)
    projected.emplace_back(point[across] - corner[across], point[up] - corner[up]);

  ScattererColumns columns;
  columns.corner = corner;
  append_groups(columns.groups, convex_hull(std::move(projected)));

  ScatterParameters& p = columns.parameters;
  double extent = 0;  // half of a cell's, in z
  for (int axis = 0; axis < 3; ++axis) {
    p.probe_from_cell[axis] = glm::vec4(probe_from_cells[axis]);
    extent += std::abs(probe_from_cells[axis].z) / 2;
  }
  p.probe_from_corner = glm::vec4(glm::dvec3(probe_from_cells * glm::dvec4(corner, 1)), half + extent);
  p.keys = glm::uvec4(kCellKeys[0], kCellKeys[1], kCellKeys[2], hash(settings.speckle_seed));
  for (int axis = 0; axis < 3; ++axis) p.keys.w += std::uint32_t(corner[axis]) * p.keys[axis];
  const auto unit = [](int axis, int sign) {
    glm::ivec4 step(0);
    step[axis] = sign;
    return step;
  };
  p.across = unit(across, 1);
  p.up = unit(up, 1);
  p.down = unit(along, probe_from_cells[along].z < 0 ? -1 : 1);
  const double rise = std::abs(probe_from_cells[along].z);
  p.z_per_step = float(rise);
  p.steps = int(2 * (half + extent) / rise) + 1;
  p.apex_mm = float(lines.fan.apex_mm);
  p.first_across = float(lines.fan.first);
  p.lines_across = float(1 / lines.fan.step);
  p.face_of_outer_line = float(std::cos(lines.fan.first));
  p.quanta = float(quanta_of(lines, settings));
  p.steering_sine = float(std::sin(lines.fan.steering));
  p.steering_cosine = float(std::cos(lines.fan.steering));
  const std::array<std::uint32_t, 3> phase = phase_steps(probe_from_cells, settings, lines.fan.steering);
  for (int axis = 0; axis < 3; ++axis) {
    p.phase_steps[axis] = phase[std::size_t(axis)];
    p.phase_steps.w += 1024u * std::uint32_t(corner[axis]) * phase[std::size_t(axis)];
  }
  p.slice_half = float(kSliceHalf);
  return columns;
}

ScattererStage::ScattererStage(const ShaderSources& sources, const WorkDivision& division)
    : division_(division),
      program_(sources, {"imaging/scatter.comp"}, {{"FACE", "1"}, {"STEERED", "0"}, {"ELEVATION_FOCUS", "0"}}) {}

void ScattererStage::lay_out(const ScanLines& of_plane, int most_planes) {
  lines_ = of_plane;
  const std::size_t rows = std::size_t(most_planes) * lines_.lines.size();
  scattered_ = TexelBuffer(GL_RG32I, rows * std::size_t(lines_.samples + 1));
  scale_ = TexelBuffer();
}

void ScattererStage::place(std::span<const Pose> patient_from_plane, const Settings& settings) {
  if (!scale_ || scale_of_ != settings) {
    std::vector<float> scale;
    for (const double c : scatterer_scale(lines_, settings)) scale.push_back(float(c / quanta_of(lines_, settings)));
    scale_ = TexelBuffer(GL_R32F, scale.size(), scale.data());
    scale_of_ = settings;
  }
  program_.define({{"FACE", std::to_string(int(lines_.fan.face))},
                   {"STEERED", flag(lines_.fan.steering != 0)},
                   {"ELEVATION_FOCUS", flag(has_elevation_focus(settings))}});
  scattered_.clear();
  for (std::size_t plane = 0; plane < patient_from_plane.size(); ++plane) {
    ScattererColumns columns = scatterer_columns(patient_from_plane[plane], lines_, settings);
    columns.parameters.first_row = int(plane * lines_.lines.size());
    const glm::ivec2 in_rows = division_.in_rows(columns.groups.size());
    // Groups that fill up the last row visit the last columns again, beyond them: far outside the lines.
    columns.groups.resize(std::size_t(in_rows.x) * std::size_t(in_rows.y), glm::ivec2(1 << 20));
    columns_.write(columns.groups.data(), columns.groups.size() * sizeof(glm::ivec2));
    parameters_.write(&columns.parameters, sizeof columns.parameters);
    parameters_.bind_uniform(2);
    columns_.bind_storage(0);
    scattered_.bind_storage(1);
    program_.dispatch_groups(in_rows.x, in_rows.y);
  }
}

}  // namespace insonate::gl
