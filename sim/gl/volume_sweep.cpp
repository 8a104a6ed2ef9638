#include "sim/gl/volume_sweep.h"

#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec4.hpp>

#include <limits>
#include <vector>

#include "sim/shaders/shared/sweep_parameters.h"

namespace insonate::gl {
namespace {

SweepParameters parameters_of(const Sweep& sweep, const SweepValues& values, const Grid& grid) {
  SweepParameters p{};
  p.planes = int(sweep.patient_from_plane.size());
  p.lines = values.lines;
  p.samples = values.samples;
  p.probe_kind = int(sweep.probe.kind);
  p.width = grid.size.x;
  p.height = grid.size.y;
  p.depth = grid.size.z;
  p.samples_per_mm = float(values.samples / sweep.depth_mm);
  p.depth_mm = float(sweep.depth_mm);
  p.face_width_mm = float(sweep.probe.width_mm);
  p.apex_behind_mm = float(apex_behind_mm(sweep.probe));  // not read for linear
  p.field_of_view = float(glm::radians(sweep.probe.field_of_view_deg));
  return p;
}

}  // namespace

VolumeSweep::VolumeSweep(const ShaderSources& sources)
    : program_(sources, {"sweep_convert.comp"}), parameters_(sizeof(SweepParameters), nullptr) {}

const Texture& VolumeSweep::convert(const Sweep& sweep, const SweepValues& values, const Grid& grid) {
  const int planes = int(sweep.patient_from_plane.size());
  values_ = Texture::make_3d(GL_R32F, values.samples, values.lines, planes, Filter::nearest, Wrap::edge);
  values_.write(GL_RED, GL_FLOAT, values.values.data());

  // Chained in double precision: single would lose digits to the patient's far origin.
  std::vector<glm::vec4> rows;
  for (const Pose& patient_from_plane : sweep.patient_from_plane) {
    const glm::dmat4 by_row = glm::transpose(patient_from_plane.inverse().matrix() * grid.matrix());
    for (int row = 0; row < 3; ++row) rows.emplace_back(by_row[row]);
  }
  plane_from_voxel_ = Texture::make_2d(GL_RGBA32F, 3, planes, Filter::nearest);
  plane_from_voxel_.write(GL_RGBA, GL_FLOAT, rows.data());

  volume_ = Texture::make_3d(GL_RG32F, grid.size.x, grid.size.y, grid.size.z, Filter::linear, Wrap::edge);
  const SweepParameters p = parameters_of(sweep, values, grid);
  parameters_.write(&p, sizeof p);
  parameters_.bind_uniform(0);
  values_.bind(0);
  plane_from_voxel_.bind(1);
  volume_.bind_image(0, GL_WRITE_ONLY);
  program_.dispatch(grid.size.x, grid.size.y, grid.size.z);
  return volume_;
}

Volume<float> read_swept_volume(const Texture& volume, const Grid& grid) {
  std::vector<glm::vec2> pixels(grid.count());
  volume.read(GL_RG, GL_FLOAT, pixels.data(), pixels.size() * sizeof(glm::vec2));
  Volume<float> swept{grid, {}};
  swept.voxels.reserve(pixels.size());
  for (const glm::vec2& pixel : pixels)
    swept.voxels.push_back(pixel.y > 0 ? pixel.x : std::numeric_limits<float>::quiet_NaN());
  return swept;
}

}  // namespace insonate::gl
