#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/imaging/scatterer_stage.h"
#include "sim/model/beam.h"
#include "sim/model/waves.h"
#include "tests/imaging/parity.h"

/// Compares the stages of model S with the reference. The tolerances are those of the model's accuracy contract.
namespace insonate::test {

/// The reference's stages of one picture, exact and over fields that are known in single precision.
struct ReferenceStages {
  Stages<double> exact;
  std::array<Stages<double>, 4> uncertain;
  Image<double> rounding;  ///< with waves: standard deviation of e, from sums of scatterers in whole numbers
};

/// Returns the standard deviation of e that whole numbers cause: each contribution to a sum is rounded by up to half a
/// quantum, and a sum has as many as there are scatterers between the neighbouring lines and samples.
inline Image<double> rounding_of_waves(const MediumField& field, const TissueTable& table, const ScanLines& lines,
                                       const Settings& settings, const Pose& pose) {
  Image<double> deviation(int(lines.lines.size()), lines.samples);
  if (!settings.speckle) return deviation;
  const std::vector<double> scale = scatterer_scale(lines, settings);
  const double quanta = gl::scatterer_columns(pose, lines, settings).parameters.quanta;
  const double cell = std::pow(scatterer_pitch_mm(lines, settings), 3);
  for (const SlicePlane& plane : slice_planes(settings)) {
    const ReferenceScan scan = traverse_reference(field, table, lines, settings, pose, plane);
    for (int k = 0; k < lines.samples; ++k) {
      const double r = lines.r_min_mm + (k + 0.5) * lines.dr_mm();
      const double spacing = lines.fan.step * (lines.fan.apex_mm > 0 ? lines.fan.apex_mm + r : 1);
      const double slice = 2 * kSliceHalf * slice_thickness_at_mm(settings, r) / settings.slice_planes;
      const double contributions = std::max(1.0, 4 * lines.dr_mm() * spacing * slice / cell);
      const double of_sum = scale[std::size_t(k)] * std::sqrt(contributions / 12) / quanta;
      for (int line = 0; line < deviation.width; ++line) {
        const double intensity = scan.intensity.at(line, k);
        const double transmitted = settings.two_way ? intensity : std::sqrt(intensity);
        const double amplitude = kRoughShare * std::abs(scan.mirror.at(line, k)) * intensity +
                                 std::sqrt(settings.blend) * scan.amplitude.at(line, k) * transmitted;
        deviation.at(line, k) = std::hypot(deviation.at(line, k), of_sum * amplitude);
      }
    }
  }
  return deviation;
}

inline ReferenceStages reference_stages(const MediumField& field, const TissueTable& table, const Probe& probe,
                                        double depth_mm, const Settings& settings, const Pose& pose) {
  ReferenceStages stages;
  stages.exact = simulate_reference(field, table, probe, depth_mm, settings, pose);
  if (settings.waves)
    stages.rounding = rounding_of_waves(field, table, scan_lines(probe, depth_mm, settings.samples), settings, pose);
  for (std::uint32_t i = 0; i < stages.uncertain.size(); ++i)
    stages.uncertain[i] =
        simulate_reference(as_single_precision_knows_it(field, i), table, probe, depth_mm, settings, pose);
  return stages;
}

/// Checks e and f of waves. The shader keeps sums of scatterers in whole numbers of 16 bits (scatter.comp), so e has
/// the random error that `rounding` gives. Through pulse and beam it adds up as random errors do. Places and weights in
/// single precision add a share of the loudest echo as far as pulse and beam reach.
inline void check_waves(const ReferenceStages& reference, const Stages<float>& got, const ScanLines& lines,
                        const Settings& settings) {
  constexpr double kDeviations = 6;  // the largest of 1e5 to 1e6 errors stays below five
  constexpr double kOfLoudest = 5e-4;
  const Stages<double>& expected = reference.exact;
  const double strongest = *std::max_element(expected.scattered.pixels.begin(), expected.scattered.pixels.end());
  const Worst scattered = worst(expected.scattered, got.scattered,
                                tolerated(expected, reference.uncertain, &Stages<double>::scattered,
                                          [&](double value) { return 3e-4 * value + 1e-10 * strongest; }));
  INFO(described("scattered", scattered));
  CHECK(scattered.error < 1);

  const Image<double>& rounding = reference.rounding;
  const std::vector<double> sigma = focused_beam_sigma(lines, settings), pulse = pulse_weights(lines, settings);
  const int n = rounding.width, d = rounding.height, along = int(pulse.size() / 2);
  Image<double> variance_along(n, d), loudest_along(n, d);  // behind the pulse
  for (int k = 0; k < d; ++k)
    for (int line = 0; line < n; ++line)
      for (int m = std::max(-along, -k); m <= std::min(along, d - 1 - k); ++m) {
        const double weighted = pulse[std::size_t(m + along)] * rounding.at(line, k + m);
        variance_along.at(line, k) += weighted * weighted;
        loudest_along.at(line, k) = std::max(
            loudest_along.at(line, k), std::hypot(expected.echo_re.at(line, k + m), expected.echo_im.at(line, k + m)));
      }
  Image<double> of_echo(n, d), of_wave(n, d);
  for (int k = 0; k < d; ++k) {
    const std::vector<double> weights = beam_weights_at(settings, sigma[std::size_t(k)]);
    const int across = int(weights.size() / 2);
    for (int line = 0; line < n; ++line) {
      double variance = 0, loudest = 0;
      for (int j = std::max(-across, -line); j <= std::min(across, n - 1 - line); ++j) {
        variance += std::pow(weights[std::size_t(j + across)], 2) * variance_along.at(line + j, k);
        loudest = std::max(loudest, loudest_along.at(line + j, k));
      }
      of_wave.at(line, k) = kDeviations * std::sqrt(variance) + kOfLoudest * loudest;
      of_echo.at(line, k) = kDeviations * rounding.at(line, k) + kOfLoudest * loudest;
    }
  }
  const auto compare = [&](const char* what, Image<double> Stages<double>::*part, const Image<float>& of_device,
                           const Image<double>& allowed) {
    Image<double> tolerance = tolerated(expected, reference.uncertain, part, [](double) { return 1e-20; });
    for (std::size_t i = 0; i < tolerance.pixels.size(); ++i) tolerance.pixels[i] += allowed.pixels[i];
    const Worst wave = worst(expected.*part, of_device, tolerance);
    INFO(described(what, wave));
    CHECK(wave.error < 1);
  };
  compare("e, real", &Stages<double>::echo_re, got.echo_re, of_echo);
  compare("e, imaginary", &Stages<double>::echo_im, got.echo_im, of_echo);
  compare("f, real", &Stages<double>::wave_re, got.wave_re, of_wave);
  compare("f, imaginary", &Stages<double>::wave_im, got.wave_im, of_wave);
}

/// Checks every stage but T, which follows from I.
inline void check_stages(const ReferenceStages& reference, const Stages<float>& got, const ScanLines& lines,
                         const Settings& settings) {
  const Stages<double>& expected = reference.exact;
  const auto tolerance = [&](Image<double> Stages<double>::*stage, auto&& basic) {
    return tolerated(expected, reference.uncertain, stage, basic);
  };

  // I: 1e-4 relative, or 1e-10 below 1e-6.
  const Worst intensity =
      worst(expected.intensity, got.intensity,
            tolerance(&Stages<double>::intensity, [](double value) { return 1e-4 * std::max(value, 1e-6); }));
  INFO(described("I", intensity));
  CHECK(intensity.error < 1);

  REQUIRE(expected.inside.pixels == got.inside.pixels);
  std::vector<int> expected_grey, got_grey;
  for (std::size_t i = 0; i < expected.grey.pixels.size(); ++i)
    if (expected.inside.pixels[i]) {
      expected_grey.push_back(expected.grey.pixels[i]);
      got_grey.push_back(got.grey.pixels[i]);
    }

  if (settings.waves) {
    const double loudest = *std::max_element(expected.fused.pixels.begin(), expected.fused.pixels.end());
    const Worst repeated = worst(expected.repeated, got.repeated,
                                 tolerance(&Stages<double>::repeated, [&](double) { return 1e-4 * loudest; }));
    INFO(described("V", repeated));
    CHECK(repeated.error < 1);
    check_waves(reference, got, lines, settings);
    check_grey_of_waves(expected_grey, got_grey);
    return;
  }

  const double brightest = *std::max_element(expected.reflection.pixels.begin(), expected.reflection.pixels.end());
  REQUIRE(brightest > 0);
  const auto of_brightest = [&](double) { return 1e-4 * brightest; };
  const Worst reflection =
      worst(expected.reflection, got.reflection, tolerance(&Stages<double>::reflection, of_brightest));
  INFO(described("R", reflection));
  CHECK(reflection.error < 1);
  const Worst beam =
      worst(expected.reflection_beam, got.reflection_beam, tolerance(&Stages<double>::reflection_beam, of_brightest));
  INFO(described("R behind the beam", beam));
  CHECK(beam.error < 1);

  const Worst repeated = worst(expected.repeated, got.repeated, tolerance(&Stages<double>::repeated, of_brightest));
  INFO(described("V", repeated));
  CHECK(repeated.error < 1);

  // The envelope of speckle passes through 0, so its error is measured relative to its mean of 1.
  const Worst speckle =
      worst(expected.speckle, got.speckle, tolerance(&Stages<double>::speckle, [](double) { return 1e-3; }));
  INFO(described("S", speckle));
  CHECK(speckle.error < 1);

  std::array<Image<double>, 4> uncertain_fused;
  for (std::size_t i = 0; i < uncertain_fused.size(); ++i) uncertain_fused[i] = reference.uncertain[i].fused;
  check_fused(expected.fused, uncertain_fused, got.fused, settings.dynamic_range_db);

  check_grey(expected_grey, got_grey);
}

}  // namespace insonate::test
