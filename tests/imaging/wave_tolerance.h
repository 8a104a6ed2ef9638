#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include "sim/core/image.h"
#include "sim/imaging/scatterer_stage.h"
#include "sim/model/beam.h"
#include "sim/model/waves.h"
#include "sim/reference/reference.h"
#include "sim/reference/reverberation_reference.h"

/// How far the shaders' e and f of sim/model/waves.h may lie from the reference's. The shaders keep sums of scatterers
/// in whole numbers of 16 bits (scatter.comp), so e has a random error, which adds up through pulse and beam as random
/// errors do. Places and weights in single precision add a share of what is summed.
namespace insonate::test {

/// Returns the standard deviation of e that whole numbers cause: each contribution to a sum is rounded by up to half a
/// quantum, and a sum has as many as there are scatterers between the neighbouring lines and samples.
inline Image<double> rounding_of_waves(const MediumField& field, const TissueTable& table, const ScanLines& lines,
                                       const Settings& settings, const Pose& pose) {
  Image<double> deviation(int(lines.lines.size()), lines.samples);
  if (!settings.speckle) return deviation;
  const std::vector<double> scale = scatterer_scale(lines, settings);
  const double quanta = gl::scatterer_columns(pose, lines, settings).parameters.quanta;
  const double cell = std::pow(scatterer_pitch_mm(lines, settings), 3);
  Image<double> rough(deviation.width, deviation.height);
  ReferenceScan middle;
  const std::vector<SlicePlane> planes = slice_planes(settings);
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const ReferenceScan scan = traverse_reference(field, table, lines, settings, pose, planes[p]);
    if (p == planes.size() / 2) middle = scan;
    for (std::size_t i = 0; i < rough.pixels.size(); ++i) {
      const double intensity = scan.intensity.pixels[i];
      const double transmitted = settings.two_way ? intensity : std::sqrt(intensity);
      rough.pixels[i] += planes[p].of_line(i % lines.lines.size()).weight *
                         std::pow(kRoughShare * scan.mirror.pixels[i] * intensity +
                                      std::sqrt(settings.blend) * scan.amplitude.pixels[i] * transmitted,
                                  2);
    }
  }
  for (int k = 0; k < lines.samples; ++k) {
    const double r = lines.r_min_mm + (k + 0.5) * lines.dr_mm();
    const double spacing = lines.fan.step * (lines.fan.apex_mm > 0 ? lines.fan.apex_mm + r : 1);
    const double mean = 4 * lines.dr_mm() * spacing * 2 * kSliceHalf * slice_thickness_at_mm(settings, r) / cell;
    const double contributions = mean + 4 * std::sqrt(mean) + 4;  // hardly any sum has more
    const double of_sum = scale[std::size_t(k)] * std::sqrt(contributions / 12) / quanta;
    for (int line = 0; line < deviation.width; ++line) deviation.at(line, k) = of_sum * std::sqrt(rough.at(line, k));
  }
  if (settings.mirror_image == 0) return deviation;
  // Images have the errors of what they show.
  Image<std::complex<double>> with_images(deviation.width, deviation.height);
  std::ranges::copy(deviation.pixels, with_images.pixels.begin());
  add_mirror_images(with_images, middle.intensity, middle.reflection, lines, settings);
  std::ranges::transform(with_images.pixels, deviation.pixels.begin(), [](const auto& e) { return std::abs(e); });
  return deviation;
}

struct WaveTolerance {
  Image<double> echo, wave;  ///< of each part of e and of f, real and imaginary
};

/// @param rounding  rounding_of_waves()
/// @param of_echo   the share of what is summed
inline WaveTolerance wave_tolerance(const Stages<double>& expected, const Image<double>& rounding,
                                    const ScanLines& lines, const Settings& settings, double of_echo = 5e-4) {
  constexpr double kDeviations = 6;  // the largest of 1e5 to 1e6 errors stays below five
  const int n = rounding.width, d = rounding.height;
  // Between scatterers e may vanish where contributions of both signs meet; its neighbours hardly do then.
  Image<double> around(n, d);
  for (int k = 0; k < d; ++k)
    for (int line = 0; line < n; ++line)
      for (int i = std::max(k - 1, 0); i <= std::min(k + 1, d - 1); ++i)
        for (int j = std::max(line - 1, 0); j <= std::min(line + 1, n - 1); ++j)
          around.at(line, k) =
              std::max(around.at(line, k), std::hypot(expected.echo_re.at(j, i), expected.echo_im.at(j, i)));

  const std::vector<double> sigma = focused_beam_sigma(lines, settings), pulse = pulse_weights(lines, settings);
  const int along = int(pulse.size() / 2);
  Image<double> variance_along(n, d), sum_along(n, d);  // behind the pulse
  for (int k = 0; k < d; ++k)
    for (int line = 0; line < n; ++line)
      for (int m = std::max(-along, -k); m <= std::min(along, d - 1 - k); ++m) {
        const double weight = pulse[std::size_t(m + along)];
        variance_along.at(line, k) += std::pow(weight * rounding.at(line, k + m), 2);
        sum_along.at(line, k) += weight * around.at(line, k + m);
      }
  WaveTolerance tolerance{Image<double>(n, d), Image<double>(n, d)};
  for (int k = 0; k < d; ++k) {
    const std::vector<double> weights = beam_weights_at(settings, sigma[std::size_t(k)]);
    const int across = int(weights.size() / 2);
    for (int line = 0; line < n; ++line) {
      double variance = 0, sum = 0;
      for (int j = std::max(-across, -line); j <= std::min(across, n - 1 - line); ++j) {
        const double weight = weights[std::size_t(j + across)];
        variance += weight * weight * variance_along.at(line + j, k);
        sum += weight * sum_along.at(line + j, k);
      }
      tolerance.wave.at(line, k) = kDeviations * std::sqrt(variance) + of_echo * sum;
      tolerance.echo.at(line, k) = kDeviations * rounding.at(line, k) + of_echo * around.at(line, k);
    }
  }
  return tolerance;
}

}  // namespace insonate::test
