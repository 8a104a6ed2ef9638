#pragma once

namespace insonate {

/// Shadows below the edges of what is round (Robinson et al., J Clin Ultrasound 9, 1981: shadowing by refraction; Steel
/// et al., Ultrasound in Medicine and Biology 30, 2004: the edge shadow's origins). Where the speed of sound changes
/// across the beam the sound turns, by grad(ln c) across it a mm (Snell's law for small steps; Kinsler et al.,
/// Fundamentals of Acoustics, 5): through a plane interface by (ln c2 - ln c1) tan(incidence), much at grazing
/// incidence and little elsewhere. What is turned far within a short way leaves the line. With b the turn across the
/// line, rad, in two components, I of (5) takes
///
///     b(r + dr) = b(r) e^(-dr/kTurn_mm) + grad(ln c) dr               across the line, by differences over l
///     I(r + dr) = I(r) ... e^(-s dr/kTurn_mm),  s = 2 q/(2 + q),  q = (|b(r + dr)|/kTurn_rad)^4
///
/// so that a plane interface costs the root of 1 + q/2, 0.1 dB at 30 degrees between fat and liver, and the limb of a
/// cyst, of a vessel or of a kidney casts a thin shadow; no more than s = 2, because a beam of some width passes a limb
/// in part. ln c is linear in density below and above water, between
/// kLeastHu and kMostHu; gas and bone count as those, because they reflect what they meet anyway.
inline constexpr double kLogSpeedBelowWater = 5e-4;    ///< a HU: fat (-100 HU) 1450 m/s (Szabo), water 1524 (Duck)
inline constexpr double kLogSpeedAboveWater = 7.6e-4;  ///< a HU: water, liver (60 HU) 1595 m/s (Mast, ARLO 1, 2000)
inline constexpr double kLeastHu = -150;               ///< fat and partly gas
inline constexpr double kMostHu = 150;                 ///< the densest soft tissue
inline constexpr double kTurn_rad = 0.1;               ///< the half angle that an aperture of f-number 5 takes in
inline constexpr double kTurn_mm = 5;  ///< estimate: within which so much parts sound from a beam about 1 mm wide

}  // namespace insonate
