#pragma once

#include <cstdint>

#include "sim/core/grid.h"
#include "sim/model/tissue.h"

namespace insonate {

/// What the simulator keeps of a voxel: 4 bytes, one texture fetch.
struct AcousticVoxel {
  std::int16_t hu = -1000;                ///< gives impedance and absorption through the tissue table
  std::int16_t echogenicity_cdb = -6000;  ///< backscatter relative to liver in hundredths of a dB
};

using AcousticVolume = Volume<AcousticVoxel>;

/// From Hounsfield units, and labels where there are any, to what the sound meets.
///
/// Echogenicity comes from the label's tissue, shifted by the voxel's own density relative to its label's mean so that
/// parenchyma keeps its texture. Without a label it comes from the density of the voxel and of those neighbours that
/// differ from it by no more than noise; there a voxel on a steep gradient that passes through fluid's density is
/// partial volume, not fluid, and takes the brighter of its neighbours.
/// @param labels     on the CT's grid, or empty
/// @param tissue_of  per label value, the tissue's name in the table ("" for none); 256 entries, or empty
AcousticVolume make_acoustic_volume(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& labels,
                                    const std::vector<std::string>& tissue_of, const TissueTable& table);

}  // namespace insonate
