#pragma once

namespace insonate {

/// Reverberation: sound caught between two reflectors at r1 < r2 goes to and fro, and shows the deeper one again and
/// again behind it, a distance r2 - r1 apart and weaker each time (Szabo, Diagnostic Ultrasound Imaging, 9; Baad et
/// al., Radiographics 37, 2017). Thin strong layers draw comet tails so. The probe's face is such a reflector at r = 0:
/// with it, gas and bone show at multiples of their depth, as the A-lines of lung ultrasound (Lichtenstein, Intensive
/// Care Medicine 24, 1998).
///
/// On each line, before the beam's width, from I and R of its samples in the middle plane of the slice, because layers
/// that lie in different planes hold no sound between them: a sample reflects A = R / I^2 = alpha |d . n|, 0 to 1; it
/// lies where its interface does, at c, the mean place of the samples nearer than the reflection length l, weighted by
/// A. The face, with A = face_reflection, lies at c = 0.
/// Samples i before j make the echo
///
///     V(c_j + k (c_j - c_i)) gets s R_j g^k,  k from 1 to kMostRepeats,     g = w A_i A_j T^2
///
/// for each round of which the sound passes what lies between twice, T = I(j - l + dr) / I(i + l), l of it in whole
/// samples, rounded up, at most 1; w rises from 0 to 1 while c_j - c_i rises from l/2 to l, because what is nearer is
/// one interface; s = dr/l shares a sharp interface's R among the samples that show it, and is 1 for the face. An echo
/// has R_j's shape: sample k of it lies as far from its place as j does from c_j; between samples it is shared among
/// the nearest four by the cubic B-spline, so that no edge of it appears at once when the probe moves; a share below
/// kLeastEcho (stages.h) is none. Rounds of less than kLeastRound are left out, though behind gas and bone they could
/// be seen: thousands of samples reflect as much. g counts as g (1 - (kLeastRound/g)^2)^8, and as 0 below, so that a
/// repeat comes up from below all that is seen while the probe moves: one that began with a slope would be there at
/// once, as decibels have no slope at 0. Of a round from the face it is A_j T^2 that counts so, with kLeastFromFace;
/// the face's own A is a factor of what counts.
///
/// V passes the beam's window (4) as R does, and adds to (6), U = (R + b T) S + V, because it is no scatterers' echo.
inline constexpr double kLeastRound = 1e-3, kLeastFromFace = 1e-2;
inline constexpr int kMostRepeats = 16;
inline constexpr int kMostReflectors = 64;  ///< samples of a line that are looked at: the first so strong
/// Sound is too weak to come back a second time where I is less.
inline constexpr double kLeastReverberant = 1e-12;

}  // namespace insonate
