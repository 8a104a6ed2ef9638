#pragma once

#include <cmath>
#include <filesystem>
#include <string>

#include "sim/volume/ct_reader.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {

/// Returns in which way a grid breaks the promises of ct_reader.h.
inline std::string broken_in_grid(const Grid& grid, std::size_t voxels) {
  if (voxels != grid.count()) return "there are not as many voxels as the grid has";
  for (int axis = 0; axis < 3; ++axis) {
    if (grid.size[axis] < 2 || grid.size[axis] > 4096) return "a side is out of range";
    if (!(grid.spacing[axis] >= 1e-3 && grid.spacing[axis] <= 100)) return "a spacing is out of range";
    if (!std::isfinite(grid.origin[axis])) return "the origin is not finite";
  }
  const glm::dmat3 product = glm::transpose(grid.direction) * grid.direction;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (!(std::abs(product[c][r] - (c == r ? 1 : 0)) < 1e-9)) return "the axes are not orthonormal";
  return "";
}

/// Reads a file as a CT and as labels, header and voxels. Returns what is broken.
inline std::string broken_by_volume(const std::filesystem::path& file) {
  const std::string broken = broken_by([&]() -> std::string {
    const Volume<std::int16_t> ct = read_ct(file);
    for (const std::int16_t hu : ct.voxels)
      if (hu < -1024) return "a voxel is below -1024 HU";
    return broken_in_grid(ct.grid, ct.voxels.size());
  });
  if (!broken.empty()) return broken;
  return broken_by([&] {
    const Volume<std::uint8_t> labels = read_labels(file);
    return broken_in_grid(labels.grid, labels.voxels.size());
  });
}

}  // namespace insonate::fuzz
