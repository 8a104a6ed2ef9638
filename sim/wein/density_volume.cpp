#include "sim/wein/density_volume.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sim/gl/headless_context.h"
#include "sim/imaging/device_volume.h"

namespace insonate::gl {
namespace {

constexpr double kStepsPerHu = 8;  // of the stored gradient, as in wein_traverse.comp

// Returns HU at a position between the voxels of a row, which lie `stride` apart; air beyond the row's ends.
double between(const AcousticVoxel* row, std::ptrdiff_t stride, int count, double at) {
  const double below = std::floor(at), share = at - below;
  const auto hu = [&](double i) {
    return i >= 0 && i < count ? double(row[std::ptrdiff_t(i) * stride].hu) : double(AcousticVoxel{}.hu);
  };
  return hu(below) + share * (hu(below + 1) - hu(below));
}

Texture stored_as(GLenum format, const Grid& grid, const std::vector<std::array<std::int16_t, 4>>& voxels) {
  const glm::ivec3 size = grid.size + 2 * kAirMargin;
  Texture texture = Texture::make_3d(format, size.x, size.y, size.z, Filter::linear, Wrap::edge);
  texture.write_inside(GL_RGBA, GL_SHORT, voxels.data(), {AcousticVoxel{}.hu, 0, 0, 0});
  return texture;
}

}  // namespace

glm::dvec3 density_change(const AcousticVolume& volume, const glm::ivec3& voxel, double reflection_length_mm) {
  const Grid& grid = volume.grid;
  const glm::tvec3<std::ptrdiff_t> stride(1, grid.size.x, std::ptrdiff_t(grid.size.x) * grid.size.y);
  const AcousticVoxel* here = volume.voxels.data() + grid.offset(voxel);
  glm::dvec3 change;
  for (int axis = 0; axis < 3; ++axis) {
    const AcousticVoxel* row = here - voxel[axis] * stride[axis];
    const double half = reflection_length_mm / 2 / grid.spacing[axis];
    change[axis] = between(row, stride[axis], grid.size[axis], voxel[axis] + half) -
                   between(row, stride[axis], grid.size[axis], voxel[axis] - half);
  }
  return change;
}

Texture density_volume(const AcousticVolume& volume, double reflection_length_mm) {
  const Grid& grid = volume.grid;
  std::vector<std::array<std::int16_t, 4>> voxels(grid.count());
  tbb::parallel_for(0, grid.size.z, [&](int z) {
    for (int y = 0; y < grid.size.y; ++y)
      for (int x = 0; x < grid.size.x; ++x) {
        const glm::ivec3 i(x, y, z);
        const std::size_t v = grid.offset(i);
        voxels[v][0] = volume.voxels[v].hu;
        const glm::dvec3 change = density_change(volume, i, reflection_length_mm);
        for (int axis = 0; axis < 3; ++axis)
          voxels[v][std::size_t(axis) + 1] =
              std::int16_t(std::lround(std::clamp(kStepsPerHu * change[axis], -32767.0, 32767.0)));
      }
  });
  // A processor uses a voxel of floats as it is, but has to unpack one of integers, which costs a tenth of an image's
  // time (`insonate-bench batch`, llvmpipe). Floats take twice the memory, which a card would have to move.
  if (is_software_renderer()) {
    try {
      return stored_as(GL_RGBA32F, grid, voxels);
    } catch (const TextureRefused&) {
      // The integers may still fit.
    }
  }
  return stored_as(GL_RGBA16_SNORM, grid, voxels);
}

}  // namespace insonate::gl
