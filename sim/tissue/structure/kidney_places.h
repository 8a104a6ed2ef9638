#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

#include "sim/core/grid.h"
#include "sim/tissue/structure/voxel_field.h"
#include "sim/tissue/tissue.h"

namespace insonate {

/// The structure of each of the 256 values of a label map.
using StructureOfLabel = std::array<Structure, 256>;

/// The box around a label's voxels with a margin of 3 voxels, within the grid. Its size is 0 if there are none.
struct LabelBox {
  glm::ivec3 low{0}, size{0};

  LabelBox(const Volume<std::uint8_t>& labels, int label);
};

/// How far the voxels of a sinus lie from the kidney's parenchyma.
class SinusRim {
public:
  SinusRim(const Volume<std::uint8_t>& labels, int label, const StructureOfLabel& structure_of);

  /// @param voxel  of the sinus
  float distance_mm(const glm::ivec3& voxel) const { return from_parenchyma_.at(voxel - box_.low); }

private:
  LabelBox box_;
  VoxelField from_parenchyma_;
};

/// The pyramids of one kidney: where a voxel lies between sinus and capsule, and the nearest point of the sinus.
class Pyramids {
public:
  Pyramids(const Volume<std::uint8_t>& labels, int label, const StructureOfLabel& structure_of);

  /// Returns false if the kidney has no sinus.
  bool exist() const { return has_sinus_; }

  struct Place {
    glm::dvec3 nearest_mm{0.0};  ///< of the sinus, patient
    float outwards = 0;          ///< 0 at the sinus, 1 at the capsule
  };
  /// @param voxel  of the kidney
  Place at(const glm::ivec3& voxel) const;

private:
  Grid grid_;
  glm::ivec3 low_{0};
  bool has_sinus_ = false;
  VoxelField from_sinus_, from_capsule_;
};

}  // namespace insonate
