#pragma once

#include "sim/shaders/shared/model_constants.h"

namespace insonate {

/// Shadows below the edges of round structures (Robinson et al., J Clin Ultrasound 9, 1981: shadowing by refraction;
/// Steel et al., Ultrasound in Medicine and Biology 30, 2004: the edge shadow's origins).
///
/// Where the speed of sound changes across the beam, the sound is deflected, per mm by grad(ln c) across the beam
/// (Snell's law for small steps; Kinsler et al., Fundamentals of Acoustics, 5). A plane interface deflects it by (ln c2
/// - ln c1) tan(incidence): much at grazing incidence and little elsewhere. Sound that is deflected far within a short
/// distance leaves the line. With b the deflection across the line, rad, in two components, I of (5) becomes
///
///     b(r + dr) = b(r) e^(-dr/kDeflection_mm) + grad(ln c) dr               across the line, by differences over l
///     I(r + dr) = I(r) ... e^(-s dr/kDeflection_mm),  s = 2 q/(2 + q),  q = (|b(r + dr)|/kDeflection_rad)^4
///
/// A plane interface thus costs the root of 1 + q/2, which is 0.1 dB at 30 degrees between fat and liver, and the limb
/// of a cyst, a vessel or a kidney casts a thin shadow. s is limited to 2, because a beam of some width passes a limb
/// in part. ln c is linear in density, with different slopes below and above water, between kMinRefracting_hu and
/// kMaxRefracting_hu. Gas and bone count as these limits, because they reflect almost everything anyway.
///
/// The slopes are those of fat (-100 HU, 1450 m/s, Szabo) and water (1524 m/s, Duck), and of water and liver (60 HU,
/// 1595 m/s, Mast, ARLO 1, 2000). kMinRefracting_hu is fat mixed with some gas, kMaxRefracting_hu the densest soft
/// tissue.
inline constexpr double kDeflection_rad = 0.1;  ///< half angle of an aperture of f-number 5
inline constexpr double kDeflection_mm =
    5;  ///< estimate: over which kDeflection_rad separates sound from a beam about 1 mm wide

}  // namespace insonate
