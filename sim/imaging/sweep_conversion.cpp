#include "sim/imaging/sweep_conversion.h"

#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <limits>
#include <utility>

#include "sim/shaders/shared/sweep_parameters.h"

namespace insonate::gl {
namespace {

SweepParameters parameters_of(const Sweep& sweep, int planes, int samples, const Grid& grid) {
  SweepParameters p{};
  p.planes = planes;
  p.lines = sweep.probe.lines;
  p.samples = samples;
  p.probe_kind = int(sweep.probe.kind);
  p.width = grid.size.x;
  p.height = grid.size.y;
  p.depth_mm = float(sweep.depth_mm);
  p.face_width_mm = float(sweep.probe.width_mm);
  p.apex_behind_mm = float(apex_behind_mm(sweep.probe));  // unused for linear probes
  p.field_of_view = float(glm::radians(sweep.probe.field_of_view_deg));
  return p;
}

}  // namespace

SweepConversion::SweepConversion(const ShaderSources& sources, const WorkDivision& division)
    : program_(sources, {"imaging/sweep_convert.comp"}), division_(division) {}

void SweepConversion::lay_out(const Grid& grid) {
  const bool as_large = grid.size == grid_.size;
  grid_ = grid;
  if (as_large && !slabs_.empty()) return;
  slabs_.clear();
  std::vector<Slab> slabs;
  const std::size_t slice = std::size_t(grid.size.x) * std::size_t(grid.size.y);
  const int most = int(std::clamp<std::size_t>(2 * division_.most_texels / slice, 1, std::size_t(grid.size.z)));
  for (int first = 0; first < grid.size.z; first += most) {
    const int slices = std::min(most, grid.size.z - first);
    slabs.push_back({first, slices, TexelBuffer(GL_RG32F, slice * std::size_t(slices))});
  }
  slabs_ = std::move(slabs);
}

void SweepConversion::convert(const Sweep& sweep, const Part& part, const TexelBuffer& values, int samples) {
  // The matrices are chained in double precision: single precision would lose digits to the patient's far origin.
  std::vector<glm::vec4> rows;
  for (int plane = part.first; plane < part.first + part.planes; ++plane) {
    const Pose plane_from_patient = sweep.patient_from_plane[std::size_t(plane)].inverse();
    const glm::dmat4 by_row = glm::transpose(plane_from_patient.matrix() * grid_.matrix());
    for (int row = 0; row < 3; ++row) rows.emplace_back(by_row[row]);
  }
  plane_from_voxel_ = TexelBuffer(GL_RGBA32F, rows.size(), rows.data());

  SweepParameters p = parameters_of(sweep, part.planes, samples, grid_);
  p.is_first_part = part.first == 0;
  values.bind(0);
  plane_from_voxel_.bind(1);
  for (const Slab& slab : slabs_) {
    p.first_slice = slab.first_slice;
    parameters_.write(&p, sizeof p);
    parameters_.bind_uniform(1);
    slab.voxels.bind_storage(0);
    program_.dispatch(grid_.size.x, grid_.size.y, slab.slices);
  }
}

Volume<float> SweepConversion::read() const {
  Volume<float> volume{grid_, {}};
  volume.voxels.reserve(grid_.count());
  std::vector<glm::vec2> read;
  for (const Slab& slab : slabs_) {
    read.resize(std::size_t(grid_.size.x) * std::size_t(grid_.size.y) * std::size_t(slab.slices));
    slab.voxels.read(read.data(), read.size() * sizeof(glm::vec2));
    for (const glm::vec2& voxel : read)
      volume.voxels.push_back(voxel.y < 0 ? std::numeric_limits<float>::quiet_NaN() : voxel.x);
  }
  return volume;
}

}  // namespace insonate::gl
