#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>
#include <vector>

namespace insonate {

/// Scalars on a box of voxels, i fastest.
struct VoxelField {
  glm::ivec3 size{0};
  std::vector<float> values;

  explicit VoxelField(const glm::ivec3& s) : size(s), values(std::size_t(s.x) * std::size_t(s.y) * std::size_t(s.z)) {}
  std::size_t offset(const glm::ivec3& i) const {
    return (std::size_t(i.z) * std::size_t(size.y) + std::size_t(i.y)) * std::size_t(size.x) + std::size_t(i.x);
  }
  float at(const glm::ivec3& i) const { return values[offset(glm::clamp(i, glm::ivec3(0), size - 1))]; }
  float& at(const glm::ivec3& i) { return values[offset(i)]; }

  /// Trilinear between voxels, constant beyond the outermost.
  float between(const glm::vec3& index) const {
    const glm::vec3 p = glm::clamp(index, glm::vec3(0), glm::vec3(size - 1));
    const glm::ivec3 low = glm::min(glm::ivec3(p), glm::max(size - 2, 0)), high = glm::min(low + 1, size - 1);
    const glm::vec3 f = p - glm::vec3(low);
    const auto row = [&](int y, int z) { return glm::mix(at({low.x, y, z}), at({high.x, y, z}), f.x); };
    return glm::mix(glm::mix(row(low.y, low.z), row(high.y, low.z), f.y),
                    glm::mix(row(low.y, high.z), row(high.y, high.z), f.y), f.z);
  }

  /// Replaces each line along an axis by change(line).
  template <typename Change>
  void along(int axis, Change change) {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    std::size_t stride = 1;
    for (int other = 0; other < axis; ++other) stride *= std::size_t(size[other]);
    tbb::parallel_for(tbb::blocked_range<int>(0, size[b]), [&](const auto& range) {
      const auto length = std::size_t(size[axis]);
      std::vector<float> line(length);
      for (int j = range.begin(); j != range.end(); ++j)
        for (int i = 0; i < size[a]; ++i) {
          glm::ivec3 start(0);
          start[a] = i;
          start[b] = j;
          float* first = values.data() + offset(start);
          for (std::size_t n = 0; n < line.size(); ++n) line[n] = first[n * stride];
          change(line);
          for (std::size_t n = 0; n < line.size(); ++n) first[n * stride] = line[n];
        }
    });
  }
};

/// Blurs by a Gaussian, whose weights at the border add up to 1 again.
/// @param spacing_mm  of the voxels
void blur(VoxelField& field, const glm::dvec3& spacing_mm, double sigma_mm);

/// Returns the distance from each voxel to the nearest one of `mask` that is above 0, mm; 10 m where none is.
VoxelField distances_to(const VoxelField& mask, const glm::dvec3& spacing_mm);

}  // namespace insonate
