#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/core/grid.h"
#include "sim/shaders/shared/model_constants.h"
#include "sim/tissue/tissue.h"

namespace insonate {

/// The acoustic data of a voxel: 4 bytes, one texture fetch.
struct AcousticVoxel {
  std::int16_t hu = -1000;                ///< determines impedance and absorption through the tissue table
  std::int16_t echogenicity_cdb = -6000;  ///< backscatter relative to liver in hundredths of a dB; -6000: no echo;
                                          ///< below that, the CT ends here: end_absorption()
};

using AcousticVolume = Volume<AcousticVoxel>;

// Texture: CT noise and structure of +-10 to 15 HU within an organ becomes +-1 to 2 dB of grain. Beyond 30 HU from the
// label's mean, the voxel is not texture but partial volume at the organ's rim. The shift fades out by 60 HU, so that
// rims get no dark or bright seam. Estimates, chosen by eye on real scans.
inline constexpr double kTextureDbPerHu = 0.1;
inline constexpr double kTexture_hu = 30;
inline constexpr double kRim_hu = 60;

// Fluid is what scatters less than this by its label. Differences of its density are noise, which would show as echoes
// of interfaces within a gallbladder or an aorta. Its density becomes even; towards the rim that fades out as texture
// does.
inline constexpr double kFluid_db = -25;

// Where a CT's first and last slice cut the body, the body goes on and the data do not. Air there would be a bright
// straight line with a mirror image behind it. Instead the last kEnd_mm of tissue before the head's and the feet's end
// absorb sound, so that the picture ends black. Absorption rises so slowly that it is not taken for gas, which has
// mirror images (mirror_image.h). Two slices at least; none in a CT of fewer than four times as many.
inline constexpr double kEnd_mm = 8;
inline constexpr double kEnd_db = -160;  // of the outermost slice

/// Returns the grid's axis that runs most nearly along the patient's, from feet to head.
int feet_head_axis(const Grid& grid);
/// Returns how many slices at each of these ends absorb sound.
int end_slices(const Grid& grid);
/// Returns the distance of a point of the patient from the nearer of these ends along that axis, mm; below 0 beyond.
double to_end_mm(const Grid& grid, const glm::dvec3& point);

// A voxel counts as partial volume if two opposite neighbours at this distance enclose its density with a margin on
// both sides. The distance spans half the blur of an edge in resampled thick slices. The margin is above what is left
// of the noise, so that noise in a cyst does not fill it with echoes.
inline constexpr double kEdgeRadius_mm = 2;
inline constexpr int kEdgeMargin_hu = 20;

// Thin muscle between fat and an organ has fluid's density in coarse voxels. A layer of up to this thickness along an
// axis, with a lighter tissue on one side and a denser one on the other, is taken for that. Thicker layers stay fluid,
// as all but the rim of a gallbladder between fat and liver; so do vessels and cysts amid an organ.
inline constexpr double kLayer_mm = 10;

// The range to which a labelled voxel is clamped: that of the tissue table.
inline constexpr double kMinEchogenicity_db = -60, kMaxEchogenicity_db = 30;

// A voxel with the least echogenicity does not scatter at all; voxels store steps of 0.01 dB. At e dB the scatterers'
// amplitude is 10^(e/10) - 10^(kSilent_db/10), so that it starts from 0 at the limit of silence.
inline constexpr double kSilent_db = kMinEchogenicity_db + 0.005;

/// Returns the acoustic volume of a CT, from its Hounsfield units and, if there are any, its labels. Throws InputError
/// for an unknown tissue, and std::invalid_argument for labels of another size or more than 256 label values.
///
/// With a label, the echogenicity is that of the label's tissue, shifted by the voxel's own density relative to its
/// label's mean. The shift preserves the texture of parenchyma. Without a label, the echogenicity follows the density.
/// There, a voxel on a steep gradient that passes through fluid's density is partial volume, not fluid, and takes the
/// brighter of its neighbours. Unenhanced kidney (30 HU) and fluid (15 HU) differ by less than the noise of one voxel,
/// so a CT without labels is first freed of noise, without_noise(ct, ct_noise_hu(ct)) (ct_noise.h); its impedance
/// follows from that too. With
///
///     g(x) = kTextureDbPerHu x clamp((kRim_hu - |x|) / (kRim_hu - kTexture_hu), 0, 1)         dB of x HU
///     T(h) = the table's echogenicity at h Hounsfield units                                dB
///
/// a voxel of H HU becomes, rounded to hundredths of a dB:
///
///     with a label of a tissue t    t's echogenicity + g(H - the mean HU of all voxels of that label), clamped to
///                                   kMinEchogenicity_db and kMaxEchogenicity_db
///     else                          T(H)
///
/// In the i-th of the n slices of an end, counted from 0 at the outermost, tissue becomes kMinEchogenicity_db +
/// (n - i) / n (kEnd_db - kMinEchogenicity_db). The voxel's density stays H, but for labels of a tissue of less than
/// kFluid_db: there it becomes H - g(H - mean) / kTextureDbPerHu, the difference rounded.
///
/// Without a label there are three exceptions. First, for each axis take the two voxels at -e and e, with e being
/// kEdgeRadius_mm in voxels, rounded, at least 1. If both lie in the grid, the lower lies kEdgeMargin_hu or more below
/// H, and the higher as much above H, the result is at least T of both. Second, in a CT without any labels, where T(H)
/// is below kFluid_db, for each axis take the nearest voxel on each side that is kEdgeMargin_hu or more from H. If one
/// is lower, but above kMaxAir_hu, and the other higher, and the voxels between them span kLayer_mm or less, the result
/// is at least T of both. Third, if a voxel and its 26 neighbours are TissueTable::densest_air_hu() or less, the result
/// is kMinEchogenicity_db: no sound gets there, and the air around the body can be skipped.
///
/// With structure, tissue_structure_cdb() is added where scatterers are: to every voxel above kMinEchogenicity_db
/// outside the ends, clamped as labelled voxels are.
/// @param labels     on the CT's grid, or empty
/// @param tissue_of  per label value, the tissue's name in the table ("" for none); 256 entries, or empty
/// @param structure  true for pictures with Settings::waves; the paper's mode and registration have none
AcousticVolume make_acoustic_volume(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& labels,
                                    const std::vector<std::string>& tissue_of, const TissueTable& table,
                                    bool structure = false);

/// Returns what a medium absorbs in addition to its density's absorption, dB/(cm MHz), one way: above 0 at an end of
/// the CT alone, also with Settings::absorption off.
inline double end_absorption(double echogenicity_db) {
  const double below = kEndless_db - echogenicity_db;
  return below > 0 ? kEndAbsorption * below * below : 0;
}

/// Returns a digest of the grid and all voxels, as digest_of() (sim/files/digest.h).
std::string digest_of(const AcousticVolume& volume);

/// Returns the amplitude of the scatterers at a place in the paper's sums, 10^(e/10) - 10^(kSilent_db/10) with e the
/// trilinear echogenicity; 0 outside the volume.
/// @param index_from_patient  the inverse of volume.grid.matrix()
double scatterer_amplitude_at(const AcousticVolume& volume, const glm::dmat4& index_from_patient,
                              const glm::dvec3& patient_mm);

}  // namespace insonate
