#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/acoustics/echo_lines.h"
#include "sim/acoustics/scenes.h"
#include "sim/acoustics/speckle_statistics.h"
#include "sim/core/hash.h"

using namespace insonate;

namespace {

double unit_random(std::uint32_t seed, std::uint32_t index) {
  return (hash(seed, index) + 0.5) / 4294967296.0;
}

// Rayleigh numbers of mean square 2.
std::vector<double> rayleigh_numbers(std::size_t count, std::uint32_t seed) {
  std::vector<double> numbers;
  for (std::uint32_t i = 0; i < count; ++i) numbers.push_back(std::sqrt(-2 * std::log(unit_random(seed, i))));
  return numbers;
}

// A small array: few rectangles per echo keep the direct sum over a million scatterers short.
Transducer small_array() {
  Transducer transducer;
  transducer.elements = 10;
  transducer.pitch_mm = 0.3;
  transducer.kerf_mm = 0.03;
  transducer.height_mm = 1.6;
  transducer.frequency_mhz = 5;
  transducer.bandwidth_percent = 70;
  transducer.excitation_cycles = 1;
  return transducer;
}

struct Speckle {
  std::vector<double> all;          // every sample
  std::vector<double> independent;  // further apart than a cell
};

// The envelopes of many lines, each of a block of its own, about a focus. Each depth is divided by the mean over the
// lines of a smooth curve through them, because speckle's mean falls with the depth.
Speckle speckle_of(double per_cell, int lines) {
  const Transducer transducer = small_array();
  Beamforming beamforming;
  beamforming.transmit_focus_mm = 15;
  const ScanLine line = line_at(transducer, 0);
  const double from = 12, to = 18;
  const BeamProfile cell = beam_profile(transducer, beamforming, line, 15);
  const ScanBeam beam(transducer, beamforming, line);
  const Pulse pulse(transducer);
  const SceneBox box{{-cell.lateral_mm, from - 1.5 * cell.axial_mm, -cell.elevation_mm},
                     {cell.lateral_mm, to + 1.5 * cell.axial_mm, cell.elevation_mm}};

  std::vector<std::vector<double>> envelopes(std::size_t(lines), std::vector<double>{});
  tbb::parallel_for(0, lines, [&](int i) {
    const std::vector<Scatterer> block = uniform_block(box, per_cell / cell_volume_mm3(cell), std::uint32_t(i + 1));
    envelopes[std::size_t(i)] = echo_line(beam, pulse, block, from, to).envelope();
  });

  // A straight line through the logarithm of the mean square of each depth.
  const std::size_t samples = envelopes[0].size();
  double sum_t = 0, sum_tt = 0, sum_y = 0, sum_ty = 0;
  for (std::size_t k = 0; k < samples; ++k) {
    double square = 0;
    for (const std::vector<double>& envelope : envelopes) square += envelope[k] * envelope[k] / lines;
    const double t = double(k), y = std::log(square) / 2;
    sum_t += t, sum_tt += t * t, sum_y += y, sum_ty += t * y;
  }
  const double n = double(samples);
  const double slope = (n * sum_ty - sum_t * sum_y) / (n * sum_tt - sum_t * sum_t);
  const std::size_t apart =
      std::size_t(1.5 * cell.axial_mm / (beamforming.sampling.step_us() * beamforming.sampling.speed_mm_us / 2));
  Speckle speckle;
  for (const std::vector<double>& envelope : envelopes)
    for (std::size_t k = 0; k < samples; ++k) {
      speckle.all.push_back(envelope[k] * std::exp(-slope * double(k)));
      if (k % apart == 0) speckle.independent.push_back(speckle.all.back());
    }
  return speckle;
}

}  // namespace

TEST_CASE("the Rayleigh test refuses a twentieth of Rayleigh numbers") {
  constexpr int kTrials = 2000;
  for (const std::size_t count : {100, 1000}) {
    int refused = 0;
    for (int i = 0; i < kTrials; ++i)
      refused += !rayleigh_test(rayleigh_numbers(count, std::uint32_t(i + 1))).is_rayleigh();
    CAPTURE(count);
    // The standard deviation of the share is 0.5 %.
    CHECK(double(refused) / kTrials == Approx(0.05).margin(0.015));
  }
}

TEST_CASE("the Rayleigh test refuses other distributions") {
  std::vector<double> numbers = rayleigh_numbers(2000, 5);
  CHECK(rayleigh_test(numbers).is_rayleigh());
  for (double& number : numbers) number *= 7;
  CHECK(rayleigh_test(numbers).is_rayleigh());  // whatever its scale
  for (double& number : numbers) number += 1;
  CHECK(!rayleigh_test(numbers).is_rayleigh());
  for (double& number : numbers) number = std::pow(number - 1, 1.2);
  CHECK(!rayleigh_test(numbers).is_rayleigh());
}

TEST_CASE("the signal-to-noise ratio of an envelope is its mean over its standard deviation") {
  CHECK(envelope_snr(std::vector<double>{1, 3}) == Approx(2));
  CHECK(envelope_snr(rayleigh_numbers(200000, 3)) == Approx(kRayleighSnr).epsilon(0.005));
  CHECK(kRayleighSnr == Approx(std::sqrt(glm::pi<double>() / (4 - glm::pi<double>()))));
}

TEST_CASE("the direct sum of many scatterers is fully developed speckle") {
  // With 40 scatterers per cell, the ratio's expectation is 1.90: a cell holds a finite number (K distribution). Over
  // 300 lines of 19 independent values, its standard error is 0.018.
  const Speckle speckle = speckle_of(40, 300);
  CHECK(speckle.independent.size() > 5000);
  CHECK(envelope_snr(speckle.all) == Approx(1.91).margin(0.03));
  CHECK(rayleigh_test(speckle.independent).is_rayleigh());
}

TEST_CASE("few scatterers per cell are not fully developed speckle") {
  const Speckle speckle = speckle_of(0.5, 300);
  CHECK(envelope_snr(speckle.all) < 1.5);
  CHECK(!rayleigh_test(speckle.independent).is_rayleigh());
}
