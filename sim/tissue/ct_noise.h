#pragma once

#include <cstdint>

#include "sim/core/grid.h"

namespace insonate {

// The voxels around a voxel are the 27 at -e, 0 and e along each axis; e is kNoiseStep_mm in voxels, rounded, at least
// 1. The step is the distance of independent voxels in thick slices: resampled to 1 mm, their noise is one smooth
// surface, and nearer voxels would show none of it. Places beyond the border are those of its outermost voxels.
inline constexpr double kNoiseStep_mm = 3;

/// The noise that any CT of an abdomen has at least, HU: that of a usual dose and slices of 3 to 5 mm.
inline constexpr double kUsualNoise_hu = 15;

inline constexpr double kMinTissue_ml = 20;  ///< from less soft tissue, noise is not measured

/// Returns the standard deviation of a CT's noise in HU, which depends on dose, slices and patient: the most frequent
/// standard deviation of the 27 voxels around a voxel of soft tissue (Christianson et al., "Automated technique to
/// measure noise in clinical CT examinations", AJR 205, 2015), in every e-th row of every e-th slice. Soft tissue has a
/// mean of 0 to 100 HU around it, and no voxel there is more than 200 HU from that. Steps are 0.5 HU. Structure counts
/// as noise where most of the body has it. Returns kUsualNoise_hu if that is more, or for less than kMinTissue_ml of
/// soft tissue.
double ct_noise_hu(const Volume<std::int16_t>& ct);

/// Returns the CT without noise of that standard deviation; edges stay where they are. The guide of a voxel is the mean
/// of itself and the six at -e or e along one axis. Each voxel becomes the mean of those of the 27 around it whose
/// guide differs from its own by at most kAlikeInGuide noise_hu (the sigma filter: Lee, Computer Vision, Graphics and
/// Image Processing 24, 1983, on a guide whose own noise hardly decides). Then once more, with the result as its own
/// guide and kAlikeInResult noise_hu. Voxels whose guide is kFiltered_hu or less, air, stay as they are. A difference
/// of voxels of more than 1000 HU counts as that, and means are rounded to whole HU. In even tissue a seventh of
/// independent noise remains. What differs from its surroundings by less than kAlikeInResult noise_hu is blurred over 6
/// mm.
/// @param noise_hu  1 to 100
Volume<std::int16_t> without_noise(const Volume<std::int16_t>& ct, double noise_hu);

inline constexpr int kFiltered_hu = -900;
inline constexpr double kAlikeInGuide = 1.6;   ///< three deviations of the difference of two guides: 3 (2/7)^(1/2)
inline constexpr double kAlikeInResult = 0.8;  ///< the same for means of 27: 3 (2/27)^(1/2)

}  // namespace insonate
