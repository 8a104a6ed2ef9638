#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/acoustics/scenes.h"
#include "sim/acoustics/speckle_sample.h"
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

SpeckleSample speckle_of(double per_cell) {
  Beamforming beamforming;
  beamforming.transmit_focus_mm = 15;
  return sample_speckle(small_array(), beamforming, per_cell, 300, 15);
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
  // 300 lines of 20 independent values, its standard error is 0.018.
  const SpeckleSample speckle = speckle_of(40);
  CHECK(speckle.independent.size() > 5000);
  CHECK(envelope_snr(speckle.all) == Approx(1.91).margin(0.03));
  CHECK(rayleigh_test(speckle.independent).is_rayleigh());
}

TEST_CASE("a sample of speckle is as strong at all depths") {
  constexpr int kLines = 300;
  const SpeckleSample speckle = speckle_of(40);
  const std::size_t depths = speckle.all.size() / kLines;
  double slope = 0;  // of the logarithm of the mean square against depth, times a constant
  for (std::size_t k = 0; k < depths; ++k) {
    double square = 0;
    for (std::size_t line = 0; line < kLines; ++line) square += std::pow(speckle.all[line * depths + k], 2);
    slope += (double(k) - double(depths - 1) / 2) * std::log(square);
  }
  CHECK(slope == Approx(0).margin(1e-6));
}

TEST_CASE("few scatterers per cell are not fully developed speckle") {
  const SpeckleSample speckle = speckle_of(0.5);
  CHECK(envelope_snr(speckle.all) < 1.5);
  CHECK(!rayleigh_test(speckle.independent).is_rayleigh());
}
