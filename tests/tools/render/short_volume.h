#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "tests/tools/render/vec3.h"

namespace outsider {

/// A volume of 16-bit numbers as insonate-render writes it: raw NRRD in the patient's frame (LPS, mm).
struct ShortVolume {
  std::array<int, 3> size{};
  std::array<Vec3, 3> step{};  ///< from one voxel to the next along each axis, at right angles
  Vec3 origin{};               ///< centre of the first voxel
  std::vector<std::int16_t> voxels;

  ShortVolume() = default;
  /// Throws std::runtime_error if the file is not such a volume.
  explicit ShortVolume(const std::filesystem::path& file);

  std::int16_t voxel(int i, int j, int k) const { return voxels[std::size_t((k * size[1] + j) * size[0] + i)]; }
  Vec3 place(int i, int j, int k) const {
    return origin + double(i) * step[0] + double(j) * step[1] + double(k) * step[2];
  }
  /// Interpolates trilinearly between voxel centres, with voxels of `outside` beyond.
  double at(const Vec3& patient_mm, double outside) const;
};

}  // namespace outsider
