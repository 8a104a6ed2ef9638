#pragma once

#include "sim/shaders/shared/model_constants.h"

namespace insonate {

/// Mirror images, with Settings::waves: gas reflects all sound that arrives. The reflected sound meets the tissue
/// before the gas a second time, from behind, and the echoes return over the gas. They arrive late and show behind the
/// gas what lies before it, as a mirror does: liver behind the diaphragm, and grey haze instead of black behind bowel
/// gas, which is called a dirty shadow (Feldman, Katyal, Blackwood, Radiographics 29, 2009: mirror images; Sommer and
/// Taylor, Radiology 135, 1980: shadows of gas).
///
/// The images are computed on each line, as if the sound came back along it. That holds for gas which is met squarely.
/// Tilted gas shows what lies beside the line instead, which is taken to be like that on the line. I is that of the
/// slice's middle plane, l the reflection length, and c the interface's place as for reverberation (reverberation.h),
/// but with kOwnPlace more for the sample itself, so that it is the sample's own within gas, and where gas is met so
/// obliquely that next to nothing returns: a mean of tiny weights would jump with the pose. A sample loses the share
///
///     A(r) = 1 - (I(r + dr) / I(r))^(l/dr),      0 where I is up to kMinReverberant
///
/// If that is gas, sample j adds to e (waves.h) at each r behind it
///
///     m^(1/2) min(n dr/l, 1) s(A_j) w T^2 k^(p-1) e((p + 1) c_j - r),   p = 1, 2, ...
///     T = I(j - l + dr) / I((p + 1) c_j - r), at most 1,   k = F^(1/2) I(j - l + dr)
///
/// with m the setting mirror_image and F face_reflection: the probe's face sends what returns back again, so that the
/// haze goes on between the repeats of the gas (A lines) and fades from one to the next. Images end with the first p of
/// k^(p-1) < kMinOfFace.
///
/// - The image has travelled the way between the gas and what scatters four times more than the echo itself.
/// - Every n-th sample counts, from the first on, with n = l / (4 dr) rounded down, at least 1.
/// - s rises smoothly, t^2 (3 - 2 t), from 0 at A = kMinMirror to 1 at kFullMirror: gas is above, bone below.
/// - w rises from 0 to 1 where what is seen lies l to 2 l before c_j, because nearer samples belong to the surface.
/// - Between samples e is linear, divided by the root of the sum of the squares of its two weights, so that images are
///   equally bright wherever they fall. I is linear. e is 0 before the first sample, and from the line's first sample
///   with s > 0 on: what lies within gas or behind it has no image.
/// - m is what a surface returns that is neither smooth nor wider than the beam.
///
/// Samples count in their order, until the sum of min(n dr/l, 1) s is kMaxMirrored; the last one counts in part.
/// Hardly any sound gets farther into gas.

}  // namespace insonate
