#pragma once

#include "sim/model/settings.h"
#include "sim/shaders/shared/model_constants.h"

namespace insonate {

/// Reverberation: sound trapped between two reflectors at r1 < r2 travels back and forth. It shows the deeper one
/// repeatedly behind it, at intervals of r2 - r1 and weaker each time (Szabo, Diagnostic Ultrasound Imaging, 9; Baad et
/// al., Radiographics 37, 2017). Thin strong layers thus produce comet tails. The probe's face is such a reflector at
/// r = 0. With it, gas and bone appear at multiples of their depth, as the A-lines of lung ultrasound (Lichtenstein,
/// Intensive Care Medicine 24, 1998).
///
/// The repeats are computed on each line, before the beam's width, from I and R of its samples in the middle plane of
/// the slice: layers in different planes trap no sound between them. A sample reflects A = R / I^2 = alpha |d . n|, 0
/// to 1. Its place is that of its interface, c: the mean place of the samples nearer than the reflection length l,
/// weighted by A. The face, with A = face_reflection, lies at c = 0. It repeats nothing in a look of steered lines
/// (compounding.h): the sound that it sends back meets the interface 2 c tan(steering) beside the line, 11 mm at 40 mm
/// and 8 degrees, where the receiving beam is 1 to 2 mm wide. So compounding weakens such repeats, as it does on
/// machines (Entrekin et al., Seminars in Ultrasound, CT and MRI 22, 2001). Samples i before j make the echo
///
///     V(c_j + k (c_j - c_i)) gets s R_j g^k,  k from 1 to kMaxRepeats,     g = w A_i A_j T^2
///
/// - In each round the sound passes twice through what lies between: T = I(j - l + dr) / I(i + l), at most 1, with l in
///   whole samples, rounded up.
/// - w rises from 0 to 1 while c_j - c_i rises from l/2 to l, because nearer samples belong to one interface.
/// - s = dr/l shares a sharp interface's R among the samples that show it; it is 1 for the face.
/// - An echo has the shape of R_j: sample k of the echo lies as far from its place as j does from c_j.
/// - Between samples the cubic B-spline shares an echo among the nearest four, so that no edge of it appears at once
///   when the probe moves. A share below kMinEcho (stages.h) is 0.
/// - Rounds below kMinRound are left out, because thousands of samples reflect as much. Behind gas and bone they
///   could be visible.
/// - g counts as g (1 - (kMinRound/g)^2)^8, and as 0 below kMinRound, so that a repeat rises from below all visible
///   levels while the probe moves. If it rose with a slope it would appear at once, as decibels have no slope at 0.
/// - For a round from the face, A_j T^2 counts in this way, with kMinFromFace; the face's own A multiplies the
///   result.
///
/// V passes through the beam's window (4) as R does. It is not an echo of scatterers, so it adds to (6):
///     U = (R + b T) S + V
///
/// kMaxReflectors is how many samples of a line count: the first ones above kMinRound. Where I is less than
/// kMinReverberant, sound is too weak to return a second time.

/// Returns A of the face for the lines of one look.
/// @param steering  LineFan::steering, rad
inline double face_reflection(const Settings& settings, double steering) {
  return steering == 0 ? settings.face_reflection : 0;
}

}  // namespace insonate
