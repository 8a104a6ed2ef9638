#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>

#include "sim/gl/objects.h"
#include "sim/tissue/acoustic_volume.h"

namespace insonate::gl {

/// Where a place lies in a row of voxels, counted from one of them: whole voxels, negative before it, and the share, 0
/// to 1, of the way to the next.
struct VoxelOffset {
  explicit VoxelOffset(double voxels);
  int whole;
  double share;
};

/// The differences of HU along the CT's axes i, j, k over the reflection length around a voxel's centre, linear between
/// voxels. Beyond the CT is air.
class DensityChange {
public:
  /// @param volume  must outlive this
  /// @param reflection_length_mm  0.01 to 20
  DensityChange(const AcousticVolume& volume, double reflection_length_mm);
  glm::dvec3 at(const glm::ivec3& voxel) const;

private:
  const AcousticVolume& volume_;
  glm::tvec3<std::ptrdiff_t> stride_;
  std::array<VoxelOffset, 3> ahead_, behind_;  // per axis
};

/// Returns a CT with its gradient: (HU, its differences along the CT's axes i, j, k in eighths of HU) / 32767, with
/// kAirMargin of air without a gradient around it. Differences above 4095 HU are clamped to that. A voxel takes 8
/// bytes. Floats of 16 bytes were tried (docs/benchmarks, `batch`). Throws TextureRefused.
/// @param reflection_length_mm  differences are taken over this length, 0.01 to 20
Texture density_volume(const AcousticVolume& volume, double reflection_length_mm);

}  // namespace insonate::gl
