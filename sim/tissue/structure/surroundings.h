#pragma once

#include <cstdint>

#include "sim/core/grid.h"
#include "sim/tissue/structure/voxel_field.h"

namespace insonate {

/// Where the voxels of a CT lie in the body, on a grid of some 3 mm.
class Surroundings {
public:
  explicit Surroundings(const Volume<std::int16_t>& ct);

  /// Returns the depth below the skin, mm, blurred by a Gaussian of 5 mm. The skin is where air begins that reaches the
  /// grid's sides (left, right, front and back), or those sides themselves.
  float depth_mm(const glm::ivec3& voxel) const { return depth_mm_.between(glm::vec3(voxel) / glm::vec3(step_)); }
  /// Returns how much of what lies around is soft tissue, 0 to 1, weighted by a Gaussian of 8 mm.
  float soft_share(const glm::ivec3& voxel) const { return soft_.between(glm::vec3(voxel) / glm::vec3(step_)); }

private:
  glm::ivec3 step_;
  VoxelField depth_mm_, soft_;
};

}  // namespace insonate
