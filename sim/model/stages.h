#pragma once

#include <cstdint>

#include "sim/core/image.h"

namespace insonate {

/// Echoes that have lost 300 dB, as much as time gain can give back, are none.
inline constexpr double kLeastEcho = 1e-30;

/// What crosses the stages of model S, for those who check or take apart a picture. Numbers in brackets are the
/// equations of Kutter, Shams, Navab (Computer Methods and Programs in Biomedicine 94, 2009), words with underscores
/// the fields of Settings. With Z the impedance and a the absorption of the tissue table, l = reflection_length_mm, d
/// the line's direction, n that of the density's gradient (of Z's where Z changes evenly with density: differences of
/// HU over l along d, along the elevation and square to both), and r_k = (k + 1/2) dr the samples' distances from the
/// face:
///
///     alpha(r) = ((Z(r + l/2) - Z(r - l/2)) / (Z(r + l/2) + Z(r - l/2)))^2                             (1)
///     I(r + dr) = I(r) (1 - alpha(r))^(dr/l) 10^(-a f dr/100),  I(0) = 1                               (5)
///     R = alpha I^2 |d . n|                                                                            (3)
///     T = I^2 if two_way, else I
///     U = (G1 R + b G2 T) S + what is heard beside                                                     (6)
///     E = U 10^((gain_db + t)/10),  0 where U is below kLeastEcho
///     grey = 255 m(clamp(1 + 10 log10(E/L) / dynamic_range_db, 0, 1)),  0 where E is 0                 (7)
///
/// To the first sample, half a step behind the face, (5) takes half a step of absorption and no interface. It has the
/// paper's recursion for l = dr; l keeps it from depending on how many samples there are. Its last factor
/// is absorption, a in dB/(cm MHz) one way, f = frequency_mhz and dr in mm (Szabo, Diagnostic Ultrasound Imaging, 4: an
/// attenuation in proportion to frequency); the paper has none. Coupling: nearer to the face than coupled_mm()
/// air counts as water without echo (kCouplingAirHu, sim/reference/reference.h); beyond, air reflects by (1) as
/// anywhere, so that a face that does not touch sees nothing. Where the slice has several planes (sim/model/beam.h),
/// I, R and the scatterers' echo are their sums by weight. An R below kLeastEcho is 0, and so is T.
///
/// In (6) R and S are behind the beam's width (4), sim/model/beam.h, G1 and G2 Gaussians in the picture of
/// reflection_sigma_mm and transmission_sigma_mm, b = blend; beside are V of reverberation.h, and noise and clutter of
/// noise.h. Time gain t is tgc_db at 8 depths, the first at the face and the last at the imaging depth, linear between:
/// an amplifier's, in dB of what U is, an intensity. White is the level L: the frame's brightest E in the paper, or
/// fixed_level, so that the picture does not pump while the probe moves. m is grey_map.
///
/// The first six lie among the scan lines: x is the line, y the sample. The last three are as the picture.
template <typename Real>
struct Stages {
  Image<Real> intensity;        ///< I, 0 to 1 (5)
  Image<Real> reflection;       ///< R before the beam's width, 0 to 1 (3)
  Image<Real> reflection_beam;  ///< R after it (4)
  Image<Real> transmission;     ///< T of (6): I, or I^2 where the echo's way back counts
  Image<Real> repeated;         ///< V behind the beam's width, of reverberation.h; 0 where there is none
  Image<Real> speckle;          ///< S: envelope of the scatterers' echo, mean 1 in liver; none at kSilentDb and below
  Image<Real> fused;            ///< U (6), before gain
  Image<std::uint8_t> inside;   ///< 1 inside the fan
  Image<std::uint8_t> grey;     ///< after log compression (7), 0 to 255
};

}  // namespace insonate
