#pragma once

#include <cstdint>

#include "sim/core/image.h"
#include "sim/shaders/shared/model_constants.h"

namespace insonate {

/// The intermediate images of model S, for checking or analysing a picture. Numbers in brackets are the equations of
/// Kutter, Shams, Navab (Computer Methods and Programs in Biomedicine 94, 2009). Words with underscores are fields of
/// Settings. With Z the impedance and a the absorption of the tissue table, l = reflection_length_mm, d the line's
/// direction, n the direction of the density's gradient, and r_k = (k + 1/2) dr the samples' distances from the face:
///
///     alpha(r) = ((Z(r + l/2) - Z(r - l/2)) / (Z(r + l/2) + Z(r - l/2)))^2                             (1)
///     I(r + dr) = I(r) (1 - alpha(r))^(dr/l) 10^(-a f dr/100),  I(0) = 1                               (5)
///     R = alpha I^2 |d . n|                                                                            (3)
///     T = I^2 if two_way, else I
///     U = (G1 R + b G2 T) S + additive echoes                                                          (6)
///     E = U 10^((gain_db + t)/10),  0 where U is below kMinEcho
///     grey = 255 m(clamp(1 + 10 log10(E/L) / dynamic_range_db, 0, 1)),  0 where E is 0                 (7)
///
/// n equals the direction of Z's gradient where Z changes evenly with density. It comes from differences of HU over l
/// along d, along the elevation, and along the direction perpendicular to both.
///
/// To the first sample, half a step behind the face, (5) applies half a step of absorption and no interface. For l = dr
/// it is the paper's recursion; l makes it independent of the number of samples. Its last factor is absorption, with a
/// in dB/(cm MHz) one way, f = frequency_mhz and dr in mm (Szabo, Diagnostic Ultrasound Imaging, 4: an attenuation in
/// proportion to frequency). The paper has no absorption.
///
/// Coupling: nearer to the face than coupling_depth_mm(), air counts as water without echo (coupling.h). Beyond, air
/// reflects by (1) as anywhere, so that a face that does not touch shows nothing. Where the slice has several planes
/// (sim/model/beam.h), I, R and the scatterers' echo are their sums by weight. An R or T below kMinEcho is 0: it has
/// lost 300 dB, as much as time gain can restore.
///
/// In (6) R and S are after the beam's width (4), sim/model/beam.h. G1 and G2 are Gaussians in the picture of
/// reflection_sigma_mm and transmission_sigma_mm; b = blend. The additive echoes are V of reverberation.h, and noise
/// and clutter of noise.h. Time gain t is tgc_db at 8 depths, the first at the face and the last at the imaging depth,
/// linear between. It is an amplifier's gain in dB of U, an intensity. White is the level L: the frame's brightest E in
/// the paper, or fixed_level, so that the brightness does not change while the probe moves. m is grey_map. Pictures may
/// be the mean of several looks (compounding.h), and filtered before the grey map (display_filter.h). The images on
/// scan lines are then those of the straight look.
///
/// Images up to `wave_im` are on scan lines: x is the line, y the sample. Those from `fused` on are on the picture's
/// pixels. With Settings::waves, echoes add up as sim/model/waves.h says, not as (3) to (6) do. `reflection`,
/// `reflection_beam`, `transmission` and `speckle` are empty then. Without it, those that need waves are empty.
template <typename Real>
struct Stages {
  Image<Real> intensity;         ///< I, 0 to 1 (5)
  Image<Real> reflection;        ///< R before the beam's width, 0 to 1 (3)
  Image<Real> reflection_beam;   ///< R after the beam's width (4)
  Image<Real> transmission;      ///< T of (6): I, or I^2 where the echo's way back counts
  Image<Real> repeated;          ///< V of reverberation.h, after the beam's width; 0 where there is none
  Image<Real> speckle;           ///< S: envelope of the scatterers' echo, mean 1 in liver; 0 at kSilent_db and below
  Image<Real> scattered;         ///< with waves: expected power of the scatterers' echo, sum_p g_p b T_p A_p^2
  Image<Real> echo_re, echo_im;  ///< with waves: e
  Image<Real> wave_re, wave_im;  ///< with waves: f
  Image<Real> fused;             ///< U (6), before gain
  Image<Real> shown;           ///< the compressed echo of (7), 0 to 1, before filter and grey map; the device keeps it
                               ///< only for persistence and filter
  Image<std::uint8_t> inside;  ///< 1 inside the fan
  Image<std::uint8_t> grey;    ///< after log compression (7), 0 to 255
};

}  // namespace insonate
