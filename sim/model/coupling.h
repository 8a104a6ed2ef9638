#pragma once

#include "sim/shaders/shared/model_constants.h"

namespace insonate {

// Coupling gel. Within the gel layer all air counts as water without echo. Voxels less dense than kCouplingTissueHu,
// such as the skin's outermost ones, count as gel in part, and the share of gel grows linearly down to kCouplingAirHu.
// If tissue turned into gel at one density, echoes of the skin would come and go while the probe moves.

/// Thickness of the gel between face and skin that pictures and scores assume, mm: an estimate of what a hand squeezes
/// on.
inline constexpr double kUsualGel_mm = 6;

}  // namespace insonate
