#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/core/grid.h"

/// What the volumes that are made for the 3D view from a CT and its labels share.
namespace insonate::view {

/// Returns the CT voxels per voxel of these volumes, along each axis: their voxels are about 2 mm.
inline glm::ivec3 view_step(const Grid& grid) {
  constexpr double kVoxel_mm = 2;
  glm::ivec3 step;
  for (int axis = 0; axis < 3; ++axis)
    step[axis] = std::clamp(int(std::lround(kVoxel_mm / grid.spacing[axis])), 1, grid.size[axis]);
  return step;
}

/// Maps 0 to 1 to 0 to 255, rounded; values beyond are clamped.
inline std::uint8_t byte(float share) {
  return std::uint8_t(std::lround(std::clamp(share, 0.0f, 1.0f) * 255));
}

/// A box of voxels, x fastest.
struct Box {
  glm::ivec3 size;

  std::size_t count() const { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); }
  std::size_t offset(int x, int y, int z) const {
    return (std::size_t(z) * std::size_t(size.y) + std::size_t(y)) * std::size_t(size.x) + std::size_t(x);
  }
  std::size_t stride(int axis) const {
    return axis == 0 ? 1 : axis == 1 ? std::size_t(size.x) : std::size_t(size.x) * std::size_t(size.y);
  }

  /// Calls `visit(x, y, z, offset)` for all voxels, planes in parallel.
  template <typename Visit>
  void for_each(const Visit& visit) const {
    tbb::parallel_for(0, size.z, [&](int z) {
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) visit(x, y, z, offset(x, y, z));
    });
  }
};

/// Smooths by (1 2 1)/4 along each axis, which rounds the steps of labels and thresholds.
template <typename T, std::size_t N>
void smooth(const Box& box, std::vector<std::array<T, N>>& values) {
  auto source = values;
  for (int axis = 0; axis < 3; ++axis) {
    box.for_each([&](int x, int y, int z, std::size_t at) {
      const int p = axis == 0 ? x : axis == 1 ? y : z;
      const std::size_t before = p > 0 ? at - box.stride(axis) : at;
      const std::size_t after = p + 1 < box.size[axis] ? at + box.stride(axis) : at;
      for (std::size_t c = 0; c < N; ++c)
        values[at][c] = T((source[before][c] + 2 * source[at][c] + source[after][c] + 2) >> 2);
    });
    source = values;
  }
}

}  // namespace insonate::view
