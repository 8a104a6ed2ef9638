#include "sim/view/body/structure_surfaces.h"

#include <glm/common.hpp>

#include "sim/view/body/voxel_box.h"

namespace insonate::view {
namespace {

constexpr glm::vec3 kUncoloured{0.75f, 0.75f, 0.78f};

}  // namespace

StructureSurfaces structure_surfaces(const Volume<std::uint8_t>& labels, const OrganColours& colours,
                                     const std::vector<std::uint8_t>& shown) {
  std::array<bool, 256> is_shown{};
  for (const std::uint8_t label : shown) is_shown[label] = true;
  StructureSurfaces surfaces;
  surfaces.step = view_step(labels.grid);
  surfaces.size = (labels.grid.size + surfaces.step - 1) / surfaces.step;
  const Box box{surfaces.size};
  surfaces.voxels.resize(box.count());
  box.for_each([&](int x, int y, int z, std::size_t at) {
    glm::vec3 colour(0);
    float coverage = 0;
    int count = 0;
    const glm::ivec3 first = glm::ivec3(x, y, z) * surfaces.step;
    const glm::ivec3 end = glm::min(first + surfaces.step, labels.grid.size);
    for (int k = first.z; k < end.z; ++k)
      for (int j = first.y; j < end.y; ++j)
        for (int i = first.x; i < end.x; ++i, ++count) {
          const std::uint8_t label = labels.at({i, j, k});
          if (!is_shown[label]) continue;
          colour += colours[label].opacity > 0 ? colours[label].colour : kUncoloured;
          coverage += 1;
        }
    const float n = float(count);
    surfaces.voxels[at] = {byte(colour.r / n), byte(colour.g / n), byte(colour.b / n), byte(coverage / n)};
  });
  smooth(box, surfaces.voxels);
  return surfaces;
}

std::vector<std::uint8_t> cells_with_structures(const StructureSurfaces& surfaces, const glm::ivec3& cells, int side) {
  const Box box{surfaces.size}, grid{cells};
  std::vector<std::uint8_t> found(grid.count(), 0);
  grid.for_each([&](int cx, int cy, int cz, std::size_t cell) {
    // A linear sample within the cell uses voxels up to one beyond those that contain its faces.
    const glm::ivec3 first = glm::ivec3(cx, cy, cz) * side;
    const glm::ivec3 low = glm::max(first / surfaces.step - 1, glm::ivec3(0));
    const glm::ivec3 high = glm::min((first + side) / surfaces.step + 2, surfaces.size);
    for (int z = low.z; z < high.z; ++z)
      for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x)
          if (surfaces.voxels[box.offset(x, y, z)][3] > 0) found[cell] = 1;
  });
  return found;
}

}  // namespace insonate::view
