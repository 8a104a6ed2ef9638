#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "tests/imaging/parity.h"
#include "tests/imaging/wave_tolerance.h"

/// Compares the stages of model S with the reference. The tolerances are those of the model's accuracy contract.
namespace insonate::test {

/// The reference's stages of one picture, exact and over fields that are known in single precision.
struct ReferenceStages {
  Stages<double> exact;
  std::array<Stages<double>, 4> uncertain;
  Image<double> rounding;  ///< with waves: rounding_of_waves()
};

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

/// Checks the scatterers' power, e and f of waves (wave_tolerance.h).
inline void check_waves(const ReferenceStages& reference, const Stages<float>& got, const ScanLines& lines,
                        const Settings& settings) {
  const Stages<double>& expected = reference.exact;
  const double strongest = *std::max_element(expected.scattered.pixels.begin(), expected.scattered.pixels.end());
  const Worst scattered = worst(expected.scattered, got.scattered,
                                tolerated(expected, reference.uncertain, &Stages<double>::scattered,
                                          [&](double value) { return 3e-4 * value + 1e-10 * strongest; }));
  INFO(described("scattered", scattered));
  CHECK(scattered.error < 1);

  const WaveTolerance allowed = wave_tolerance(expected, reference.rounding, lines, settings);
  const auto compare = [&](const char* what, Image<double> Stages<double>::*part, const Image<float>& of_device,
                           const Image<double>& of_rounding) {
    Image<double> tolerance = tolerated(expected, reference.uncertain, part, [](double) { return 1e-20; });
    for (std::size_t i = 0; i < tolerance.pixels.size(); ++i) tolerance.pixels[i] += of_rounding.pixels[i];
    const Worst wave = worst(expected.*part, of_device, tolerance);
    INFO(described(what, wave));
    CHECK(wave.error < 1);
  };
  compare("e, real", &Stages<double>::echo_re, got.echo_re, allowed.echo);
  compare("e, imaginary", &Stages<double>::echo_im, got.echo_im, allowed.echo);
  compare("f, real", &Stages<double>::wave_re, got.wave_re, allowed.wave);
  compare("f, imaginary", &Stages<double>::wave_im, got.wave_im, allowed.wave);
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
    check_grey_of_waves(expected_grey, got_grey, std::max(settings.gain_db, 0.0));
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
