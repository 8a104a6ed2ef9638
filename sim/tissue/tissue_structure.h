#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/core/grid.h"
#include "sim/tissue/tissue.h"

/// The structure of tissues that a CT does not show: what makes liver, muscle and fat look different in ultrasound at
/// the same brightness. It is added to the echogenicity of the acoustic volume, once per patient. So a frame costs as
/// much as without it, and the reference sees the same volume.
///
/// Structure is a function of the place in the patient, its depth below the skin, and a seed. With N independent smooth
/// noises (smooth_noise() of p in units of a grain), p the place in patient mm, d the depth in mm, and
///
///     share(x)      = clamp(x, 0, 1)
///     sheet(n, w)   = share(1.6 (1 - |n| / w))           bright where the noise passes through zero: a surface
///     tube(r, a, h) = share(1.6 (1 - |r - a| / h))       bright at the distance a from a line
///
/// it is, in dB, less its mean:
///
///     even       0.4 N(p / 2 mm)
///     medulla    0.4 N(p / 2 mm)
///     glandular  2.2 N(p / 3.5 mm)
///     sinus      2.5 N(p / 5 mm) + 1.5 N(p / 2.5 mm) - 9 tube(r'', 0, 1.3 mm)
///                - 7 (1 - share((f + 2 mm N(p / 6 mm)) / 5 mm))
///     mixed      2.5 N(p / 6 mm) + 1.5 N(p / 2.5 mm)
///     organ      k (9 tube(r, 1.8 mm, 1.6 mm) - 8 tube(r, 0, 1 mm)) - 8 k' tube(r', 0, 2 mm) + 0.5 N(p / 8 mm)
///     muscle     11 m (sheet(N(q(16, 30, 3.2)), 0.7) - 0.35) + 2 N(q(5, 30, 1.7))
///     fat        11 m (sheet(N(q(16, 16, 4)), 0.65) - 0.35) + 0.7 N(p / 5 mm)
///     kidney     -7 share(2 N(s / 9 mm) + 0.6) share(6 (0.72 - t)) + 0.4 N(p / 2 mm)
///
/// - organ: portal tracts are the lines along which two noises of a grain g are both zero, g = 14 mm: r = g (N_1^2 +
///   N_2^2)^(1/2) / 2.6, where 2.6 is the noise's mean slope at a zero. They are walls around a lumen. Small hepatic
///   veins are lines without walls, g = 16 mm. k = share(0.5 + N(p / 18 mm)) lets lines begin and end. Portal branches
///   have echogenic walls throughout the liver, and hepatic veins have none (Rumack, Diagnostic Ultrasound).
/// - muscle and fat: q(a, b, c) = (x / a, y / a, z / b) + u d / c, in mm, with the unit vector u along (0.6, 0.5,
///   0.62). So the noise changes quickly with depth and slowly along the skin and the body's axis z, as the layers of a
///   body wall do. m = 0.65 + 0.35 clamp(N(p / 20 mm), -1, 1) keeps sheets from filling evenly. The perimysium is
///   bright between dark fascicles: parallel lines along them, dots and short lines across them (Lee et al., Sonography
///   of lower limb muscle injury, AJR 182, 2004). Fat below the skin is dark, with thin bright septa that mostly lie
///   parallel to the skin.
/// - kidney: where a kidney's label has a sinus and no tissue of the case is a medulla, pyramids are dark cones from
///   the sinus outwards. t is the place between sinus (0) and capsule (1) by distance, s the nearest point of the
///   sinus. Cortex outside the pyramids is 7 to 10 mm thick, of a parenchyma of 15 to 20 mm (Hansen, Nielsen, Ewertsen,
///   Diagnostics 6, 2016); here it is thinner, because the label's surface is blurred by voxels. Kidneys without a
///   sinus are even.
///
/// - sinus: fat between vessels, calyces and the pelvis, which makes the bright, uneven middle of a kidney (Rumack,
///   Diagnostic Ultrasound). r'' is that of dark lines, interlobar vessels and calyces, g = 11 mm. f is the distance
///   from the parenchyma, voxels with the structure kidney or medulla. Towards it the fat gets less between papillae,
///   so that the sinus has no sharp outline. Without parenchyma beside it the last term is 0.
///
/// Amplitudes, grains and widths are estimates, by eye. Thicknesses w and h grow with the largest side of a voxel, if
/// that is above 1 mm. A voxel of 1 mm holds no single perimysium of 0.1 mm; what is drawn are groups of them, of the
/// size that a beam of 1 to 2 mm tells apart.
namespace insonate {

/// A label is a number of 8 bits.
inline constexpr int kLabelValues = 256;

/// Structure is bounded: no voxel is shifted by more, dB.
inline constexpr double kMaxStructure_db = 8;

/// Larger voxels, mm, cannot hold structure, and get none. Cases and scans are resampled to 1 mm before.
inline constexpr double kLargestStructuredVoxel_mm = 1.6;

/// The seed that all programs take.
inline constexpr std::uint32_t kStructureSeed = 0x51a7u;

/// Returns what structure adds to each voxel's echogenicity, hundredths of a dB.
///
/// A voxel with a label gets the structure of its tissue (LabelledTissue::structure), and the mean over each label is
/// 0. A voxel without one is judged by its density. It is fat to the share that rises from -150 to -130 HU and falls
/// from -45 to -20 HU, and soft tissue to the share that rises there and falls from 100 to 130 HU. Soft tissue is
/// muscle down to a depth of 55 to 65 mm in a case with labels, because those name the organs. Without labels it is
/// muscle there where less than 70 to 80 % of the surroundings, a Gaussian of 8 mm, are soft tissue. Soft tissue
/// elsewhere has the structure of an organ at half strength. The mean is that of the formulas, 0. Fluid without a label
/// is shifted too, but stays far below what a display shows.
///
/// The skin is where air begins that reaches the grid's sides (left, right, front and back), or those sides themselves.
/// @param labels     on the CT's grid, or empty
/// @param tissue_of  per label value, the tissue's name in the table ("" for none); 256 entries, or empty
std::vector<std::int16_t> tissue_structure_cdb(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& labels,
                                               const std::vector<std::string>& tissue_of, const TissueTable& table,
                                               std::uint32_t seed = kStructureSeed);

}  // namespace insonate
