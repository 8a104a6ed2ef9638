#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/core/grid.h"
#include "sim/view/body/organ_colours.h"

namespace insonate::view {

/// The surfaces of some labelled structures, for drawing them within the CT. A surface lies where the coverage is one
/// half; smoothing has rounded the steps of the labels' voxels.
struct StructureSurfaces {
  glm::ivec3 size{0};                               ///< voxels of about 2 mm as in TissueClasses, x fastest
  glm::ivec3 step{1};                               ///< CT voxels per voxel, along each axis
  std::vector<std::array<std::uint8_t, 4>> voxels;  ///< colour times coverage, and the coverage by the structures
};

/// Returns the surfaces of structures. Uses all cores.
/// @param labels  on the CT's grid, not empty
/// @param shown   label values, each 1 to 255; one without a colour is drawn light grey
StructureSurfaces structure_surfaces(const Volume<std::uint8_t>& labels, const OrganColours& colours,
                                     const std::vector<std::uint8_t>& shown);

/// Returns 1 for each cube of `side` CT voxels in which a linear sample can find a structure, else 0.
/// @param cells  cubes along each axis
std::vector<std::uint8_t> cells_with_structures(const StructureSurfaces& surfaces, const glm::ivec3& cells, int side);

}  // namespace insonate::view
