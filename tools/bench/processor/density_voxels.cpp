#include "tools/bench/processor/density_voxels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "sim/wein/density_volume.h"

namespace insonate::bench {

DensityVoxels::DensityVoxels(const AcousticVolume& volume, double reflection_length_mm) : grid(volume.grid) {
  row = std::size_t(grid.size.x) + 3;
  layer = row * (std::size_t(grid.size.y) + 3);
  voxels.resize(layer * (std::size_t(grid.size.z) + 3));
  const gl::DensityChange change_of(volume, reflection_length_mm);
  tbb::parallel_for(0, grid.size.z, [&](int k) {
    for (int j = 0; j < grid.size.y; ++j)
      for (int i = 0; i < grid.size.x; ++i) {
        DensityVoxel& voxel = voxels[std::size_t(k + 1) * layer + std::size_t(j + 1) * row + std::size_t(i + 1)];
        voxel.hu = volume.at({i, j, k}).hu;
        const glm::dvec3 change = change_of.at({i, j, k});
        for (int axis = 0; axis < 3; ++axis) voxel.gradient[axis] = float(change[axis]);
      }
  });
}

ProcessorFan::ProcessorFan(const Probe& probe, double depth_mm, const WeinSettings& settings)
    : lines(scan_lines(probe, depth_mm, settings.samples)), width(settings.image_width), height(settings.image_height) {
  const ImageGeometry geometry = image_geometry(probe, depth_mm, width, height);
  const int last_line = int(lines.lines.size()) - 1, last_sample = lines.samples - 1;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = line_position(probe, depth_mm, geometry.plane_mm(x, y));
      if (!at) continue;
      const double line = std::clamp(at->line, 0.0, double(last_line));
      const double sample = std::clamp((at->r_mm - lines.r_min_mm) / lines.dr_mm() - 0.5, 0.0, double(last_sample));
      const int l = int(line), s = int(sample);
      pixels.push_back({y * width + x, l, s, l < last_line, s < last_sample, float(line - l), float(sample - s)});
    }
}

}  // namespace insonate::bench
