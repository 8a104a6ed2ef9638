// Tests the accuracy contract where a formula gives the answer, with the double-precision reference on media without
// voxels. Tolerances are those of rounding unless stated otherwise; docs/accuracy.md lists the measured figures.

#include <catch2/catch.hpp>

#include <initializer_list>

#include "tests/accuracy/media.h"

using namespace insonate;
using namespace insonate::test;

namespace {

double sum(const Image<double>& image) {
  double total = 0;
  for (double value : image.pixels) total += value;
  return total;
}

/// Returns by how many reflection lengths the mean depth of an interface's echo lies in front of the interface. Within
/// the length the sound falls as exp(-c s/2) and the echo is weighted by its square, so the echo's front outweighs its
/// end. 0 for weak interfaces.
double forward_pull(double alpha) {
  const double c = -2 * std::log(1 - alpha);
  return 0.5 - (1 / c - 1 / std::expm1(c));
}

}  // namespace

TEST_CASE("homogeneous medium: no echo, and absorption by the decibel") {
  for (const double frequency : {0.5, 3.5, 30.0}) {
    Settings settings = without_absorption(0.5);
    settings.absorption = true;
    settings.frequency_mhz = frequency;
    const ScanLines lines = one_line(160, 500);
    const auto scan = traverse_reference(
        [](const glm::dvec3&) {
          return Medium{200, 0};
        },
        plain_table(), lines, settings, {});
    for (int k = 0; k < lines.samples; ++k) {
      const double r = (k + 0.5) * lines.dr_mm();
      CHECK(scan.reflection.at(0, k) == 0);
      CHECK(scan.intensity.at(0, k) == Approx(std::pow(10, -0.5 * frequency * r / 100)).epsilon(1e-12));
    }
  }
}

TEST_CASE("sharp interface: 1 - alpha is transmitted, and the echo lies at its depth, however it meets the samples") {
  const double l = 0.8;
  for (const double behind : {101.0, 500.0, 1000.0})
    for (const int m : {1, 2, 3, 8, 32})
      for (const double phase : {0.137, 0.49, 0.77}) {
        const ScanLines lines = one_line(40, 50 * m);  // dr = l / m
        const double dr = lines.dr_mm(), depth = 20 + phase * dr, alpha = plain_alpha(100, behind);
        INFO("alpha " << alpha << ", dr = l/" << m << ", phase " << phase);
        const auto scan =
            traverse_reference(interface_at(depth, 100, behind), plain_table(), lines, without_absorption(l), {});
        CHECK(scan.intensity.at(0, lines.samples - 1) == Approx(1 - alpha).epsilon(1e-12));

        double first = -1, last = -1, weighted = 0;
        for (int k = 0; k < lines.samples; ++k) {
          const double r = (k + 0.5) * dr, echo = scan.reflection.at(0, k);
          if (echo > 0) last = r;
          if (echo > 0 && first < 0) first = r;
          weighted += r * echo;
        }
        CHECK(std::abs((first + last) / 2 - depth) <= dr / 2 + 1e-12);
        CHECK(std::abs(last - first + dr - l) <= dr + 1e-12);  // axial width: the reflection length, in whole samples
        const double centre = weighted / sum(scan.reflection);
        CHECK(std::abs(centre - (depth - forward_pull(alpha) * l)) <= dr / 2 + 1e-12);
      }
}

TEST_CASE("sharp interface: the echo's integral over depth is the continuous model's") {
  const double l = 0.8;
  for (const double behind : {101.0, 500.0, 1000.0}) {
    const double alpha = plain_alpha(100, behind);
    const double expected = alpha * l * (std::pow(1 - alpha, 2) - 1) / (2 * std::log1p(-alpha));
    double previous = 1;
    for (const int m : {8, 16, 32, 64, 128}) {
      const ScanLines lines = one_line(8, 10 * m);
      const double depth = 4 + lines.dr_mm() * 0.137;
      const auto scan =
          traverse_reference(interface_at(depth, 100, behind), plain_table(), lines, without_absorption(l), {});
      const double error = std::abs(sum(scan.reflection) * lines.dr_mm() / expected - 1);
      INFO("alpha " << alpha << ", dr = l/" << m << ": relative error " << error);
      // The sum is a geometric series: its error is -ln(1 - alpha)/m, and the next term is at most a tenth of it here.
      CHECK(error < -1.1 * std::log1p(-alpha) / m + 1e-12);
      CHECK(error < 0.55 * previous);  // linear, plus the next term
      previous = error;
    }
  }
}

TEST_CASE("layers transmit the product of what each transmits") {
  const auto hu = {100.0, 300.0, 50.0, 700.0, 200.0, 201.0, 900.0, 0.0};
  const MediumField layers = [&](const glm::dvec3& p) {
    return Medium{hu.begin()[std::clamp(int(p.y / 7.013), 0, 7)], 0};
  };
  for (const int m : {1, 2, 4}) {
    const ScanLines lines = one_line(60, 150 * m);
    const auto scan = traverse_reference(layers, plain_table(), lines, without_absorption(0.4), {});
    double expected = 1;
    for (const double* layer = hu.begin(); layer + 1 < hu.end(); ++layer)
      expected *= 1 - plain_alpha(layer[0], layer[1]);
    CHECK(scan.intensity.at(0, lines.samples - 1) == Approx(expected).epsilon(1e-12));
  }
}

TEST_CASE("tilted interface: the echo falls with the cosine of its tilt") {
  // Blurred over several reflection lengths, as CT blurs every interface. The path through the tilted ramp is longer by
  // 1/cos, and alpha falls with cos^2 over it. So the area of the echo falls by cos, and once more by |d . n|.
  const ScanLines lines = one_line(40, 4000);
  const auto area = [&](double tilt) {
    return sum(
        traverse_reference(interface_at(20, 300, 310, tilt, 4), plain_table(), lines, without_absorption(0.1), {})
            .reflection);
  };
  const double upright = area(0);
  for (const double tilt : {15.0, 30.0, 45.0, 60.0}) {
    INFO("tilt " << tilt);
    const double cosine = std::cos(glm::radians(tilt));
    CHECK(area(tilt) / upright == Approx(cosine * cosine).epsilon(0.01));
  }
}

TEST_CASE("tilted interface: |d . n| is the cosine of its tilt at every sample of the ramp") {
  const double l = 0.1, ramp = 4, depth = 20;
  const ScanLines lines = one_line(40, 2000);
  for (const double tilt : {0.0, 15.0, 30.0, 45.0, 60.0}) {
    const MediumField field = interface_at(depth, 300, 310, tilt, ramp);
    const auto scan = traverse_reference(field, plain_table(), lines, without_absorption(l), {});
    const double cosine = std::cos(glm::radians(tilt));
    int seen = 0;
    for (int k = 0; k < lines.samples; ++k) {
      const double r = (k + 0.5) * lines.dr_mm();
      if (std::abs(r - depth) * cosine > ramp / 2 - l) continue;  // the ramp's ends, where the normal jumps
      const double alpha = plain_alpha(field({0, r - l / 2, 0}).hu, field({0, r + l / 2, 0}).hu);
      const double intensity = scan.intensity.at(0, k);
      CHECK(scan.reflection.at(0, k) / (alpha * intensity * intensity) == Approx(cosine).epsilon(1e-9));
      ++seen;
    }
    CHECK(seen > 150);
  }
}
