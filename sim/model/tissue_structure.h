#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/core/grid.h"
#include "sim/model/tissue.h"

/// The structure of tissues that a CT does not show: what makes liver, muscle and fat look different in ultrasound at
/// the same brightness. It is added to the echogenicity of the acoustic volume, once per patient, so that a frame costs
/// as much as without it, and the reference sees the same volume.
///
/// Structure is a function of the place in the patient and a seed. With N_i independent smooth noise of unit deviation
/// (smooth_noise()), p the place in patient mm, d its depth below the skin, u a fixed direction, and
///
///     sheet(n, w)  = max(0, 1 - |n| / w)              bright where the noise passes through zero: a surface
///     tube(r, a, h) = max(0, 1 - |r - a| / h)         bright at the distance a from a line
///     share(x)     = clamp(x, 0, 1)
///
/// it is, in dB, less the mean:
///
///     even      0.4 N(p / 2 mm)                                            spleen
///     organ     k (6 tube(r, 1.7, 1.3) - 4 tube(r, 0, 1)) - 5 k' tube(r', 0, 1.5) + 0.5 N(p / 8 mm)       liver
///     muscle    7 m sheet(N(q_muscle), 0.8) + 0.5 N(p / 4 mm)
///     fat       6 m sheet(N(q_fat), 0.5) + 0.7 N(p / 5 mm)
///     glandular 1.8 N(p / 3 mm)                                            pancreas
///     mixed     2 N(p / 5 mm) + 1 N(p / 2 mm)                              content of bowel and stomach
///     kidney    pyramids (below) + 0.4 N(p / 2 mm)
///
/// - organ: portal tracts are lines along which two noises of a grain of 13 mm are both zero: r = 13 mm (N_1^2 +
///   N_2^2)^(1/2) / 2.6, 2.6 being the noise's mean slope at a zero. They are walls around a lumen. Small hepatic veins
///   are lines without walls (r', 16 mm). k = share(0.5 + N(p / 18 mm)) lets lines begin and end. Portal branches have
///   echogenic walls throughout the liver and hepatic veins have none (Rumack, Diagnostic Ultrasound).
/// - muscle and fat: sheets lie parallel to the skin, as the septa of subcutaneous fat and the perimysium of the body
///   wall do. q = p / (across, across, along) + u d / apart, with 3.2 mm apart, 7 mm across and 28 mm along the body's
///   axis for muscle, and 6, 14 and 14 mm for fat. m = 0.6 + 0.4 clamp(N(p / 20 mm), -1, 1) keeps them from filling
///   evenly. Perimysium is bright between dark fascicles: stripes along them, dots and short lines across them. Septa
///   of subcutaneous fat are thin bright lines parallel to the skin (Lee and Healy, AJR 182, 2004).
/// - kidney: where a kidney's label has a sinus within and the case has no medulla of its own, pyramids are dark cones
///   from the sinus outwards. With t the place between sinus (0) and capsule (1), by distance, and s the nearest point
///   of the sinus, they are -5 share(1.5 N(s / 9 mm) + 0.4) share(4 (0.65 - t)). The cortex outside them is 7 to 10 mm
///   thick, a third to a half of the parenchyma (Hansen, Nielsen, Ewertsen, Diagnostics 6, 2015).
///
/// Amplitudes, grains and widths are estimates, by eye beside clinical pictures. Thicknesses are at least 1 mm, because
/// a voxel has that; a single perimysium of 0.1 mm is not drawn, but what a beam of 1.5 mm makes of a group of them.
namespace insonate {

/// Structure is bounded: no voxel is shifted by more, dB.
inline constexpr double kMostStructureDb = 8;

/// Larger voxels, mm, cannot hold structure, and get none. Cases and scans are resampled to 1 mm before.
inline constexpr double kLargestStructuredVoxel_mm = 1.6;

/// The seed that all programs take.
inline constexpr std::uint32_t kStructureSeed = 0x51a7u;

/// Returns what structure adds to each voxel's echogenicity, hundredths of a dB.
///
/// A voxel with a label gets the structure of its tissue (LabelledTissue::structure), and the mean over each label is
/// 0. A voxel without one is judged by density: fat from -140 to -50 HU, soft tissue from 20 to 110 HU, each fading out
/// over some 20 HU; all else, such as fluid, gets none. Soft tissue there is muscle in thin layers, where less than
/// three quarters of the surroundings (a Gaussian of 8 mm) are soft tissue, within 60 mm of the skin. It is muscle
/// throughout the outer 60 mm in a case with labels, because those name the organs. Elsewhere it has the structure of
/// an organ at half strength. The mean is that of the formulas, 0.
///
/// The skin is where air begins that reaches the grid's sides, or those sides, left and right, front and back.
/// @param labels     on the CT's grid, or empty
/// @param tissue_of  per label value, the tissue's name in the table ("" for none); 256 entries, or empty
std::vector<std::int16_t> tissue_structure_cdb(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& labels,
                                               const std::vector<std::string>& tissue_of, const TissueTable& table,
                                               std::uint32_t seed = kStructureSeed);

}  // namespace insonate
