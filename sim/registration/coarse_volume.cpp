#include "sim/registration/coarse_volume.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace insonate {

AcousticVolume coarse_volume(const AcousticVolume& volume, double spacing_mm) {
  const Grid& fine = volume.grid;
  // A voxel of exactly half of the spacing may be a little larger in floating point.
  const glm::ivec3 block = glm::max(glm::ivec3(glm::floor(spacing_mm / fine.spacing + 1e-6)), glm::ivec3(1));
  AcousticVolume coarse;
  coarse.grid = fine;
  coarse.grid.size = (fine.size + block - 1) / block;
  coarse.grid.spacing = fine.spacing * glm::dvec3(block);
  coarse.grid.origin = fine.patient_from_index(glm::dvec3(block - 1) / 2.0);
  coarse.voxels.resize(coarse.grid.count());
  tbb::parallel_for(0, coarse.grid.size.z, [&](int z) {
    for (int y = 0; y < coarse.grid.size.y; ++y)
      for (int x = 0; x < coarse.grid.size.x; ++x) {
        const glm::ivec3 first = glm::ivec3(x, y, z) * block, end = glm::min(first + block, fine.size);
        std::int64_t sum = 0;
        for (int k = first.z; k < end.z; ++k)
          for (int j = first.y; j < end.y; ++j) {
            const AcousticVoxel* row = volume.voxels.data() + fine.offset({0, j, k});
            for (int i = first.x; i < end.x; ++i) sum += row[i].hu;
          }
        const glm::ivec3 held = end - first;
        const double mean = double(sum) / (double(held.x) * held.y * held.z);
        coarse.at({x, y, z}).hu = std::int16_t(std::lround(mean));
      }
  });
  return coarse;
}

}  // namespace insonate
