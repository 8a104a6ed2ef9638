#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/core/grid.h"
#include "sim/view/body/organ_colours.h"

namespace insonate::view {

/// The name of the look that these data give: labelled organs and bone as surfaces, and the skin as glass.
inline constexpr const char* kSurfaces = "Surfaces";

/// The data of a patient for volume rendering, computed once. Ray casting then costs two fetches per sample, for any
/// number of labels. Organs get smooth surfaces, which labels alone do not have.
struct TissueClasses {
  glm::ivec3 size{0};  ///< voxels of about 2 mm, x fastest
  glm::ivec3 step{1};  ///< CT voxels per voxel, along each axis

  std::vector<std::array<std::uint8_t, 4>> tissue;  ///< colour times coverage, and the coverage by organs and bone
  std::vector<std::array<std::uint8_t, 2>> body;    ///< opacity of 1 mm times coverage, and share of the body
  std::vector<std::array<std::int16_t, 1>> hu;      ///< smoothed Hounsfield units, for the direction of surfaces

  static constexpr int kBlock = 2;     ///< voxels per side of a block
  glm::ivec3 blocks{0};                ///< blocks along each axis
  std::vector<std::uint8_t> distance;  ///< per block: as distance_map() returns, to the nearest change
};

/// Returns the classes of a CT. Labels define organs. Density also defines bone, so that a CT without labels shows its
/// skeleton. The body is the largest object that is not connected to the surrounding air, without sheets of up to two
/// voxels that touch it; neither the scanner's table nor gas in the bowel has a skin.
TissueClasses classify_tissue(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& labels,
                              const OrganColours& colours);

/// Returns 1 for each cube of `side` CT voxels in which no linear sample of `classes.body` finds the body, else 0.
/// @param cells  cubes along each axis
std::vector<std::uint8_t> cells_outside_body(const TissueClasses& classes, const glm::ivec3& cells, int side);

}  // namespace insonate::view
