#include "sim/acoustics/speckle_volume.h"

#include <glm/common.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/acoustics/beam_profile.h"
#include "sim/core/hash.h"

namespace insonate {
namespace {

constexpr int kChunkVoxels = 48;  // along i and k: what is computed at once

/// Where a column of voxels lies among the lines: the same for all k.
struct VoxelPlace {
  double line = 0, r_mm = 0;
  std::size_t depth = 0;
  bool inside = false;
};

double width_of_line(const LineFan& fan, double r_mm) {
  return fan.face == LineFan::Face::parallel ? fan.step : fan.step * (fan.apex_mm + r_mm);
}

/// Voxels that are computed at once, and the sums of the echoes there.
class Chunk {
public:
  Chunk(const SpecklePlan& plan, const Grid& grid, const ResponseTable& table, const ScanLines& lines,
        const glm::ivec3& first, const glm::ivec3& end)
      : grid_(grid),
        table_(table),
        lines_(lines),
        size_(end - first),
        origin_(plan.patient_from_probe.inverse().point(grid.patient_from_index(glm::dvec3(first)))),
        sums_(std::size_t(size_.x) * std::size_t(size_.y) * std::size_t(size_.z)) {
    for (int j = 0; j < size_.y; ++j)
      for (int i = 0; i < size_.x; ++i) {
        const glm::dvec2 at(origin_.x + i * grid.spacing.x, origin_.y + j * grid.spacing.y);
        const LinePosition position = position_among(lines.fan, at);
        places_.push_back(
            {position.line, position.r_mm, table.depth_index(position.r_mm), position_within(lines, at).has_value()});
        if (!places_.back().inside) continue;
        across_mm_ = std::max(across_mm_, table.across_mm(places_.back().depth));
        elevation_mm_ = std::max(elevation_mm_, table.elevation_mm(places_.back().depth));
      }
  }

  /// Returns the box of the scatterers that are heard, mm in the probe's frame; empty where no voxel is in the fan.
  std::pair<glm::dvec3, glm::dvec3> heard_mm() const {
    if (across_mm_ == 0) return {glm::dvec3(0), glm::dvec3(0)};
    // Lines cross the chunk obliquely, so scatterers beside one lie above or below by their distance at most.
    const double beside = across_mm_ + table_.along_mm();
    const glm::dvec3 margin(beside, beside, elevation_mm_);
    return {origin_ - margin, origin_ + grid_.spacing * glm::dvec3(size_ - 1) + margin};
  }

  void add(const PlacedScatterer& scatterer) {
    const LinePosition line = position_among(lines_.fan, {scatterer.place_mm.x, scatterer.place_mm.y});
    const std::complex<double> echo = std::polar(scatterer.amplitude, -table_.phase_per_mm() * line.r_mm);
    const double z = scatterer.place_mm.z - origin_.z, along = table_.along_mm();
    const int k_low = std::max(int(std::ceil((z - elevation_mm_) / grid_.spacing.z)), 0),
              k_high = std::min(int(std::floor((z + elevation_mm_) / grid_.spacing.z)), size_.z - 1);
    const std::size_t layer = std::size_t(size_.x) * std::size_t(size_.y);
    for (std::size_t column = 0; column < places_.size(); ++column) {
      const VoxelPlace& place = places_[column];
      const double behind = place.r_mm - line.r_mm;
      if (!place.inside || std::abs(behind) >= along) continue;
      const double across = (line.line - place.line) * width_of_line(lines_.fan, place.r_mm);
      if (std::abs(across) >= table_.across_mm(place.depth)) continue;
      for (int k = k_low; k <= k_high; ++k)
        sums_[std::size_t(k) * layer + column] +=
            echo * table_.at(place.depth, across, z - k * grid_.spacing.z, behind);
    }
  }

  double envelope(int i, int j, int k) const {
    return std::abs(
        sums_[(std::size_t(k) * std::size_t(size_.y) + std::size_t(j)) * std::size_t(size_.x) + std::size_t(i)]);
  }

private:
  const Grid& grid_;
  const ResponseTable& table_;
  const ScanLines& lines_;
  glm::ivec3 size_;
  glm::dvec3 origin_;  // of voxel 0 in the probe's frame
  std::vector<VoxelPlace> places_;
  double across_mm_ = 0, elevation_mm_ = 0;
  std::vector<std::complex<double>> sums_;
};

}  // namespace

SpecklePlan speckle_plan(const Probe& probe, const Transducer& transducer, const Pose& patient_from_probe,
                         double depth_mm) {
  SpecklePlan plan{transducer, Beamforming{}, probe, patient_from_probe};
  plan.depth_mm = depth_mm;
  plan.beamforming.transmit_focus_mm = depth_mm / 2;
  plan.beamforming.transmit_f_number = plan.beamforming.receive_f_number = 3.5;
  plan.beamforming.transmit_apodization = plan.beamforming.receive_apodization = Apodization::hann;
  const ScanLine line = line_at(transducer, 0);
  double smallest = 1e9;
  for (const double share : {0.25, 0.5, 0.75}) {
    const BeamProfile cell = beam_profile(transducer, plan.beamforming, line, share * depth_mm);
    smallest = std::min(smallest, cell.axial_mm * cell.lateral_mm * cell.elevation_mm);
  }
  plan.cell_mm = std::clamp(std::cbrt(smallest / 10), 0.05, 5.0);
  return plan;
}

Grid speckle_grid(const SpecklePlan& plan) {
  const ImageGeometry picture = image_geometry(plan.probe, plan.depth_mm, 1000, 1000);
  const glm::dvec2 low = picture.plane_mm(-0.5, -0.5), high = picture.plane_mm(999.5, 999.5);
  const double half =
      plan.probe.kind == ProbeKind::linear
          ? plan.probe.width_mm / 2
          : (plan.probe.radius_mm + plan.depth_mm) *
                std::sin(std::min(glm::radians(plan.probe.field_of_view_deg) / 2, glm::half_pi<double>()));
  const double top = plan.probe.kind == ProbeKind::linear ? 0 : face_edge(plan.probe).y;
  Grid grid;
  grid.spacing = glm::dvec3(2, 1, 3) * plan.voxel_mm;
  const glm::dvec3 from(std::max(-half, low.x), std::max(top, low.y), -plan.thickness_mm / 2),
      to(std::min(half, high.x), plan.depth_mm, plan.thickness_mm / 2);
  grid.size = glm::ivec3(glm::ceil((to - from) / grid.spacing)) + 1;
  const glm::dvec3 middle = (from + to) / 2.0, half_size = grid.spacing * glm::dvec3(grid.size - 1) / 2.0;
  grid.direction = plan.patient_from_probe.rotation;
  grid.origin = plan.patient_from_probe.point(middle - half_size);
  return grid;
}

int strip_count(const Grid& grid) {
  return (grid.size.y + kStripVoxels - 1) / kStripVoxels;
}

void for_each_scatterer(const SpecklePlan& plan, const glm::dvec3& low_mm, const glm::dvec3& high_mm,
                        const AmplitudeAt& amplitude, const std::function<void(const PlacedScatterer&)>& take) {
  glm::dvec3 low(1e300), high(-1e300);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 at = plan.patient_from_probe.point(
        {corner & 1 ? low_mm.x : high_mm.x, corner & 2 ? low_mm.y : high_mm.y, corner & 4 ? low_mm.z : high_mm.z});
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  const Pose probe_from_patient = plan.patient_from_probe.inverse();
  const glm::ivec3 first(glm::floor(low / plan.cell_mm)), last(glm::floor(high / plan.cell_mm));
  for (int z = first.z; z <= last.z; ++z)
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) {
        const std::uint32_t h = hash(plan.seed, std::uint32_t(x), std::uint32_t(y), std::uint32_t(z));
        const auto share = [&](std::uint32_t axis) { return unit_float(hash(h, axis)); };
        const glm::dvec3 patient = plan.cell_mm * (glm::dvec3(x, y, z) + glm::dvec3(share(0), share(1), share(2)));
        const glm::dvec3 place = probe_from_patient.point(patient);
        if (glm::any(glm::lessThan(place, low_mm)) || glm::any(glm::greaterThanEqual(place, high_mm))) continue;
        const double size = amplitude(patient);
        if (size > 0) take({place, h & 1u ? size : -size});
      }
}

std::vector<float> speckle_strip(const SpecklePlan& plan, const Grid& grid, const ResponseTable& table,
                                 const AmplitudeAt& amplitude, int strip) {
  const ScanLines lines = scan_lines(plan.probe, plan.depth_mm, 512);
  const int j_first = strip * kStripVoxels, j_end = std::min(j_first + kStripVoxels, grid.size.y);
  const int height = j_end - j_first;
  std::vector<float> voxels(std::size_t(grid.size.x) * std::size_t(height) * std::size_t(grid.size.z));
  for (int k = 0; k < grid.size.z; k += kChunkVoxels)
    for (int i = 0; i < grid.size.x; i += kChunkVoxels) {
      const glm::ivec3 first(i, j_first, k),
          end(std::min(i + kChunkVoxels, grid.size.x), j_end, std::min(k + kChunkVoxels, grid.size.z));
      Chunk chunk(plan, grid, table, lines, first, end);
      const auto [low, high] = chunk.heard_mm();
      if (low == high) continue;
      for_each_scatterer(plan, low, high, amplitude, [&](const PlacedScatterer& scatterer) { chunk.add(scatterer); });
      const glm::ivec3 size = end - first;
      for (int c = 0; c < size.z; ++c)
        for (int b = 0; b < size.y; ++b)
          for (int a = 0; a < size.x; ++a)
            voxels[(std::size_t(k + c) * std::size_t(height) + std::size_t(b)) * std::size_t(grid.size.x) +
                   std::size_t(i + a)] = float(chunk.envelope(a, b, c));
    }
  return voxels;
}

}  // namespace insonate
