#pragma once

#include <glm/vec2.hpp>

#include <complex>
#include <numeric>

#include "sim/core/image.h"
#include "sim/core/pose.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"

namespace insonate {

/// Returns the receiver's electronic noise after its filter, as an envelope of mean 1: x line, y sample.
///
/// Thermal noise is complex, normal and independent between lines. The filter that passes the pulse correlates it over
/// about the axial resolution. Complex normal numbers are therefore placed one reflection length apart along each line,
/// interpolated linearly between, and scaled to equal variance. Their magnitude is Rayleigh distributed (Goodman,
/// Statistical Optics, 2.9). The noise depends on depth in mm and not on the number of samples per line. The numbers
/// are hashes of line and place. Every frame has the same ones, so that a still picture is still.
Image<double> electronic_noise(const ScanLines& lines, const Settings& settings);

/// The same as complex numbers whose squared magnitude has mean 1, as waves need it (sim/model/waves.h). There the
/// noise, times the root of noise_level() and clutter, is added to f.
Image<std::complex<double>> noise_wave(const ScanLines& lines, const Settings& settings);

/// Returns the shift of the noise wave in a picture, pixels: pixel (x, y) has the noise of pixel ((x + shift.x) %
/// width, (y + shift.y) % height), which lies among lines and samples that repeat beyond the fan. It is a hash of the
/// pose in single precision. So noise is new in each frame of a moving probe, and the same for the same pose.
/// @param look  a look (compounding.h) counted from 1, or 0 for the straight one; each has noise of its own
glm::ivec2 noise_shift(const Pose& patient_from_probe, int look = 0);

/// Returns the noise wave at a pixel before that shift, bilinear between lines and samples with the power of a line. It
/// repeats beyond the fan. In front of the face it is that of the same distance behind.
std::complex<double> noise_of_pixel(const Image<std::complex<double>>& noise, const ImageGeometry& geometry,
                                    const ScanLines& lines, int x, int y);

/// Returns the shift of the noise, in lines, from one plane of a volume to the next. It is about the golden section of
/// the lines, so that neighbouring planes have the noise far apart. It has no common divisor with `lines`, so that the
/// noise repeats only after `lines` planes.
/// @param lines  per plane, 1 or more
constexpr int noise_step(int lines) {
  const int golden = (618 * lines + 500) / 1000;
  for (int apart = 0;; ++apart)
    for (const int step : {golden - apart, golden + apart})
      if (std::gcd(step, lines) == 1) return step;
}

/// Returns the line whose noise a line of a volume's plane has. The same noise in all planes would be a streak through
/// the volume. Plane 0 has the noise of a picture.
/// @param line, plane  0 or more
constexpr int noise_line(int line, int plane, int lines) {
  return (line + plane * noise_step(lines)) % lines;
}

/// Returns the mean of the noise in units of U, before gain: `noise_db` relative to the level that is white; 0 if it is
/// off.
double noise_level(const Settings& settings);

/// Returns the clutter from side lobes, as a share of the mean over all lines of b T S at the same distance from the
/// face: 10^(clutter_db/10), 0 if clutter is off.
///
/// Side lobes point in all directions at once. Their echo arrives together with the echo from the same distance in the
/// main beam, whatever lies there, in random phase (Szabo, Diagnostic Ultrasound Imaging, 7: side lobes; Lediju et al.,
/// Ultrasonic Imaging 30, 2008: 0 to -30 dB in bladders). Only scatterers contribute: an interface that a side
/// lobe meets obliquely reflects the sound elsewhere. Clutter is speckled like the noise, and keeps fluid beside bright
/// tissue from being perfectly black.
///
/// Part of it was reflected several times on its way and arrives late. It therefore fades behind tissue that ends,
/// instead of stopping. The mean m of each sample is replaced by M:
///
///     M(k + 1) = m(k + 1) + (M(k) - m(k + 1)) e^(-dr/kClutterTail_mm),  M(0) = m(0)
double clutter_share(const Settings& settings);
inline constexpr double kClutterTail_mm = 5;  ///< estimate: 0.9 dB per mm, faster than any tissue's echo falls

/// Clutter from the body wall, with waves and Settings::clutter. Layers near the probe send sound back to the face,
/// which sends part of it in again, and the tissue returns it a second time. These echoes are late and diffuse. They
/// lie as haze over what is just behind the wall, such as the front of a full bladder (Lediju et al., Proc IEEE
/// Ultrasonics Symposium 2008, 50: reverberation in the abdominal wall is the main clutter behind it; Dahl and Sheth,
/// Ultrasound in Medicine and Biology 40, 2014: layers of fat and connective tissue cause it). With f of waves.h and
/// means over the lines of the plane at sample k:
///
///     E(k) = max(mean of min(|f|^2, kLayerShare I^2) - kMinLayerEcho, 0)
///     P(n) = sum_i E(i) E(n - i)
///     H(k) = kWallReturn (dr/l) (P(k - 1) + P(k)) / 2
///     J(k) = mean of I^2
///
/// The power min(H, I^2 H/J) is added to the noise's, and 0 where J is up to kMinEcho. Both values of a depth and I^2
/// are interpolated at pixels. The ways of echoes from samples i and j add up to that of one between samples i + j and
/// i + j + 1. I^2/J keeps the haze out of shadows: sound that is sent in again does not get there either.
///
/// - kLayerShare is an estimate: an interface of fat and muscle reflects ((1.65 - 1.38) / (1.65 + 1.38))^2 = 0.008
///   (tissues.toml), and sheets thinner than the pulse return less. Bone and gas, whose strong repeats run along the
///   line (reverberation.h), count as such a layer.
/// - kWallReturn is an estimate. It gives -17 dB at the front of the built-in patient's bladder, relative to the
///   scatterers beside it. Lediju et al. (Ultrasonic Imaging 30, 2008) measured 0 to -30 dB in five bladders, relative
///   to the wall's mean.
/// - kMinLayerEcho keeps products within single precision.

}  // namespace insonate
