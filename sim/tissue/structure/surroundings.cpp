#include "sim/tissue/structure/surroundings.h"

#include <glm/common.hpp>

#include <cmath>
#include <vector>

#include "sim/tissue/tissue.h"

namespace insonate {
namespace {

constexpr double kDepthBlur_mm = 5, kSoftBlur_mm = 8;

/// True for an axis that leads out of the body at its sides, not at the head's and the feet's end.
bool is_across(const Grid& grid, int axis) {
  for (int other = 0; other < 3; ++other)
    if (std::abs(grid.direction[other].z) > std::abs(grid.direction[axis].z)) return true;
  return false;
}

}  // namespace

Surroundings::Surroundings(const Volume<std::int16_t>& ct)
    : step_(glm::max(glm::ivec3(glm::round(3.0 / ct.grid.spacing)), 1)),
      depth_mm_((ct.grid.size + step_ - 1) / step_),
      soft_(depth_mm_.size) {
  const glm::dvec3 spacing = ct.grid.spacing * glm::dvec3(step_);
  VoxelField outside(depth_mm_.size);
  std::vector<glm::ivec3> reached;
  const auto reach = [&](const glm::ivec3& i) {
    if (outside.at(i) > 0 || ct.at(i * step_) > kMaxAir_hu) return;
    outside.at(i) = 1;
    reached.push_back(i);
  };
  const glm::ivec3 size = outside.size;
  for (int axis = 0; axis < 3; ++axis)
    if (is_across(ct.grid, axis)) {
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      for (int i = 0; i < size[a]; ++i)
        for (int j = 0; j < size[b]; ++j)
          for (const int end : {0, size[axis] - 1}) {
            glm::ivec3 at(0);
            at[axis] = end;
            at[a] = i;
            at[b] = j;
            reach(at);
            outside.at(at) = 1;
          }
    }
  while (!reached.empty()) {
    const glm::ivec3 from = reached.back();
    reached.pop_back();
    for (int axis = 0; axis < 3; ++axis)
      for (const int way : {-1, 1}) {
        glm::ivec3 to = from;
        to[axis] += way;
        if (to[axis] >= 0 && to[axis] < size[axis]) reach(to);
      }
  }
  depth_mm_ = distances_to(outside, spacing);
  blur(depth_mm_, spacing, kDepthBlur_mm);
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const int hu = ct.at(glm::ivec3(x, y, z) * step_);
        soft_.at({x, y, z}) = hu > 0 && hu < 130 ? 1.0f : 0.0f;
      }
  blur(soft_, spacing, kSoftBlur_mm);
}

}  // namespace insonate
