#pragma once

#include <numeric>

#include "sim/core/image.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"

namespace insonate {

/// The receiver's electronic noise behind its filter, as an envelope of mean 1: x line, y sample.
///
/// Thermal noise is complex, normal and independent from line to line; the filter that passes the pulse leaves it
/// correlated over about the axial resolution. So complex normal numbers stand a reflection length apart along each
/// line and are interpolated linearly between, brought back to equal variance; their magnitude is Rayleigh distributed
/// (Goodman, Statistical Optics, 2.9). It depends on depth in mm and not on how many samples a line has. The numbers
/// are hashes of line and place: every frame has the same ones, so that a still picture is still.
Image<double> electronic_noise(const ScanLines& lines, const Settings& settings);

/// By how many lines the noise is shifted from a volume's plane to the next: about the golden section of them, so that
/// neighbouring planes have it far apart, and without a common divisor, so that it is back after `lines` planes only.
/// @param lines  of a plane, 1 or more
constexpr int noise_step(int lines) {
  const int golden = (618 * lines + 500) / 1000;
  for (int apart = 0;; ++apart)
    for (const int step : {golden - apart, golden + apart})
      if (std::gcd(step, lines) == 1) return step;
}

/// Whose noise a line of a volume's plane has. One line's noise in all planes would be a streak through the volume.
/// Plane 0 is the plane of a picture.
/// @param line, plane  0 or more
constexpr int noise_line(int line, int plane, int lines) {
  return (line + plane * noise_step(lines)) % lines;
}

/// The mean of the noise in units of U, before gain: `noise_db` below the level that is white; 0 when it is off.
double noise_level(const Settings& settings);

/// What the side lobes let in, as a share of the mean over all lines of b T S at the same distance from the face:
/// 10^(clutter_db/10), 0 when clutter is off. Side lobes look every way at once, so that what they bring arrives when
/// the echo from that distance does, whatever lies in the main beam, in random phase (Szabo, Diagnostic Ultrasound
/// Imaging, 7: side lobes; Lediju et al., IEEE UFFC 55, 2008: clutter of 0 to -30 dB in the abdomen). It is scatterers'
/// echo alone: an interface that a side lobe meets aslant sends the sound elsewhere. Speckled as the noise is, it keeps
/// fluid beside bright tissue from being perfectly black.
///
/// Some of it has gone to and fro on its way and is late, so that it fades behind tissue that ends instead of stopping:
/// the mean m of each sample goes with
///
///     M(k + 1) = m(k + 1) + (M(k) - m(k + 1)) e^(-dr/kClutterTail_mm),  M(0) = m(0)
double clutter_share(const Settings& settings);
inline constexpr double kClutterTail_mm = 5;  ///< estimate: 0.9 dB a mm, faster than any tissue's echo falls

}  // namespace insonate
