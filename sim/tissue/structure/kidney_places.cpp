#include "sim/tissue/structure/kidney_places.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace insonate {
namespace {

constexpr int kMargin = 3;
constexpr double kBlur_mm = 1.5;

}  // namespace

LabelBox::LabelBox(const Volume<std::uint8_t>& labels, int label) {
  const glm::ivec3 grid = labels.grid.size;
  glm::ivec3 least = grid, most(-1);
  std::size_t v = 0;
  for (int z = 0; z < grid.z; ++z)
    for (int y = 0; y < grid.y; ++y)
      for (int x = 0; x < grid.x; ++x, ++v)
        if (labels.voxels[v] == label) {
          least = glm::min(least, {x, y, z});
          most = glm::max(most, {x, y, z});
        }
  if (most.x < 0) return;
  low = glm::max(least - kMargin, 0);
  size = glm::min(most + kMargin, grid - 1) - low + 1;
}

SinusRim::SinusRim(const Volume<std::uint8_t>& labels, int label, const StructureOfLabel& structure_of)
    : box_(labels, label), from_parenchyma_(box_.size) {
  VoxelField parenchyma(box_.size);
  for (int z = 0; z < box_.size.z; ++z)
    for (int y = 0; y < box_.size.y; ++y)
      for (int x = 0; x < box_.size.x; ++x) {
        const Structure here = structure_of[labels.at(box_.low + glm::ivec3(x, y, z))];
        parenchyma.at({x, y, z}) = here == Structure::kidney || here == Structure::medulla ? 1.0f : 0.0f;
      }
  from_parenchyma_ = distances_to(parenchyma, labels.grid.spacing);
}

Pyramids::Pyramids(const Volume<std::uint8_t>& labels, int label, const StructureOfLabel& structure_of)
    : grid_(labels.grid), from_sinus_(glm::ivec3(0)), from_capsule_(glm::ivec3(0)) {
  const LabelBox box(labels, label);
  low_ = box.low;
  const glm::ivec3 size = box.size;
  VoxelField sinus(size), outside(size);
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const std::uint8_t here = labels.at(low_ + glm::ivec3(x, y, z));
        const bool is_sinus = structure_of[here] == Structure::sinus;
        has_sinus_ = has_sinus_ || is_sinus;
        sinus.at({x, y, z}) = is_sinus ? 1.0f : 0.0f;
        outside.at({x, y, z}) = is_sinus || here == label ? 0.0f : 1.0f;
      }
  if (!has_sinus_) return;
  from_sinus_ = distances_to(sinus, grid_.spacing);
  from_capsule_ = distances_to(outside, grid_.spacing);
  blur(from_sinus_, grid_.spacing, kBlur_mm);
  blur(from_capsule_, grid_.spacing, kBlur_mm);
}

Pyramids::Place Pyramids::at(const glm::ivec3& voxel) const {
  const glm::ivec3 i = voxel - low_;
  const float sinus = from_sinus_.at(i), capsule = from_capsule_.at(i);
  glm::dvec3 slope(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    glm::ivec3 step(0);
    step[axis] = 2;
    slope[axis] = (from_sinus_.at(i + step) - from_sinus_.at(i - step)) / (4 * grid_.spacing[axis]);
  }
  const double length = glm::length(slope);
  if (length > 0) slope *= double(sinus) / length;
  return {grid_.patient_from_index(glm::dvec3(voxel) - slope / grid_.spacing),
          sinus / std::max(sinus + capsule, 1e-3f)};
}

}  // namespace insonate
