#include "sim/wein/density_volume.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sim/imaging/device_volume.h"

namespace insonate::gl {
namespace {

constexpr double kStepsPerHu = 8;  // of the stored gradient, as in wein_traverse.comp

// Returns HU at an offset from voxel i of a row, whose `count` voxels lie `stride` apart; air beyond its ends.
double hu_at(const AcousticVoxel* voxel, int i, std::ptrdiff_t stride, int count, const VoxelOffset& place) {
  const int below = i + place.whole;
  const double hu = below >= 0 && below < count ? voxel[place.whole * stride].hu : AcousticVoxel{}.hu,
               next = below >= -1 && below < count - 1 ? voxel[(place.whole + 1) * stride].hu : AcousticVoxel{}.hu;
  return hu + place.share * (next - hu);
}

// Returns half a length along each axis.
std::array<VoxelOffset, 3> half_a_length(const Grid& grid, double length_mm) {
  const auto along = [&](int axis) { return VoxelOffset(length_mm / 2 / grid.spacing[axis]); };
  return {along(0), along(1), along(2)};
}

}  // namespace

VoxelOffset::VoxelOffset(double voxels) : whole(int(std::floor(voxels))), share(voxels - whole) {}

DensityChange::DensityChange(const AcousticVolume& volume, double reflection_length_mm)
    : volume_(volume),
      stride_(1, volume.grid.size.x, std::ptrdiff_t(volume.grid.size.x) * volume.grid.size.y),
      ahead_(half_a_length(volume.grid, reflection_length_mm)),
      behind_(half_a_length(volume.grid, -reflection_length_mm)) {}

glm::dvec3 DensityChange::at(const glm::ivec3& voxel) const {
  const AcousticVoxel* here = volume_.voxels.data() + volume_.grid.offset(voxel);
  glm::dvec3 change;
  for (int axis = 0; axis < 3; ++axis) {
    const int i = voxel[axis], count = volume_.grid.size[axis];
    change[axis] = hu_at(here, i, stride_[axis], count, ahead_[std::size_t(axis)]) -
                   hu_at(here, i, stride_[axis], count, behind_[std::size_t(axis)]);
  }
  return change;
}

Texture density_volume(const AcousticVolume& volume, double reflection_length_mm) {
  const Grid& grid = volume.grid;
  const DensityChange change_of(volume, reflection_length_mm);
  std::vector<std::array<std::int16_t, 4>> voxels(grid.count());
  tbb::parallel_for(0, grid.size.z, [&](int z) {
    for (int y = 0; y < grid.size.y; ++y)
      for (int x = 0; x < grid.size.x; ++x) {
        const glm::ivec3 i(x, y, z);
        const std::size_t v = grid.offset(i);
        voxels[v][0] = volume.voxels[v].hu;
        const glm::dvec3 change = change_of.at(i);
        for (int axis = 0; axis < 3; ++axis)
          voxels[v][std::size_t(axis) + 1] =
              std::int16_t(std::lround(std::clamp(kStepsPerHu * change[axis], -32767.0, 32767.0)));
      }
  });
  const glm::ivec3 size = grid.size + 2 * kAirMargin;
  Texture texture = Texture::make_3d(GL_RGBA16_SNORM, size.x, size.y, size.z, Filter::linear, Wrap::edge);
  texture.write_inside(GL_RGBA, GL_SHORT, voxels.data(), {AcousticVoxel{}.hu, 0, 0, 0});
  return texture;
}

}  // namespace insonate::gl
