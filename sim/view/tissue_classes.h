#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/core/grid.h"
#include "sim/view/organ_colours.h"

namespace insonate::view {

/// What a volume view draws of a patient, worked out once: ray casting then costs two fetches a sample, whatever the
/// number of labels, and organs get smooth surfaces, which labels as such do not have.
struct TissueClasses {
  glm::ivec3 size{0};  ///< voxels of about 2 mm, x fastest
  glm::ivec3 step{1};  ///< voxels of the CT in each of them

  std::vector<std::array<std::uint8_t, 4>> tissue;  ///< colour times coverage, and the coverage of organs and bone
  std::vector<std::array<std::uint8_t, 2>> body;    ///< the opacity of 1 mm times coverage; share of the patient's body

  static constexpr int kBlock = 2;     ///< voxels a side
  glm::ivec3 blocks{0};                ///< blocks along each axis
  std::vector<std::uint8_t> distance;  ///< per block: blocks (Chebyshev) to the nearest one where something changes
};

/// Organs as their labels say; bone also by density, so that a CT without labels shows its skeleton. The body is the
/// largest thing that the air around it does not reach: neither the scanner's table nor gas in the bowel has a skin.
TissueClasses classify_tissue(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& labels,
                              const OrganColours& colours);

}  // namespace insonate::view
