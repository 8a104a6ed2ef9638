#pragma once

#include "sim/shaders/shared/model_constants.h"

namespace insonate {

// Coupling gel. Within the gel layer all air counts as water without echo. Voxels less dense than kCouplingTissue_hu,
// such as the skin's outermost ones, count as gel in part, and the share of gel grows linearly down to kCouplingAir_hu.
// If tissue turned into gel at one density, echoes of the skin would come and go while the probe moves.
//
// Where the skin is farther away than the gel reaches, gel ends in air. Sound is lost there, but little of it returns
// to the line: gel that touches nothing has a round surface, not one parallel to the face. With Settings::waves, |d .
// n|^m is multiplied by kFreeGelShare where the end of the layer lies within an interface's reflection length, r - l/2
// < coupling_depth_mm() <= r + l/2, as far as the medium at r + l/2 is air (by the share of gel that would take its
// place). A layer counts from kMinGel_mm beyond l/2 on. kFreeGelShare is an estimate, by which the repeats between
// the face and the surface lie below what shows. Without it, they are ladders at the edges of a fan that loses contact.

/// Thickness of the gel between face and skin that pictures and scores assume, mm: an estimate of what a hand squeezes
/// on.
inline constexpr double kUsualGel_mm = 6;

}  // namespace insonate
