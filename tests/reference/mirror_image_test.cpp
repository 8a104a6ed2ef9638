// Mirror images by gas, against what can be worked out by hand.

#include "sim/model/mirror_image.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <utility>
#include <vector>

#include "sim/reference/reference.h"
#include "sim/reference/reverberation_reference.h"
#include "tests/accuracy/media.h"

using namespace insonate;
using namespace insonate::test;

namespace {

constexpr double kGas_mm = 20;

/// Water to 20 mm, gas behind.
const TissueTable kWaterAndGas{{{0, 1.5, 0, 0}, {1000, 0.0004, 0, 0}}, {}};

Settings mirroring(double share) {
  Settings settings = without_absorption(0.2);  // two samples of 0.1 mm per reflection length
  settings.waves = true;
  settings.mirror_image = share;
  return settings;
}

/// Returns the magnitude of the echo of one line of 60 mm, 1 at lit samples, with its images.
std::vector<double> with_images(const Settings& settings, const TissueTable& table, double gas_mm,
                                std::pair<double, double> lit_mm) {
  const ScanLines lines = one_line(60, 600);
  const ReferenceScan scan = traverse_reference(
      [=](const glm::dvec3& p) {
        return Medium{p.y > gas_mm ? 1000.0 : 0.0, 0};
      },
      table, lines, settings, {});
  Image<std::complex<double>> echo(1, lines.samples);
  for (int k = 0; k < lines.samples; ++k)
    if (const double r = (k + 0.5) * 0.1; r > lit_mm.first && r < lit_mm.second) echo.at(0, k) = {0.6, 0.8};
  add_mirror_images(echo, scan.intensity, scan.reflection, lines, settings);
  std::vector<double> magnitudes;
  for (const std::complex<double>& e : echo.pixels) magnitudes.push_back(std::abs(e));
  return magnitudes;
}

}  // namespace

TEST_CASE("gas shows behind it, equally far, what lies before it") {
  const std::vector<double> seen = with_images(mirroring(0.25), kWaterAndGas, kGas_mm, {12, 14});
  // Samples 120 to 139 are lit; those equally far behind the gas at 200 are 260 to 279.
  // What the sample itself counts among the surface's strengths, kOwnPlace, moves the image by as large a share of one.
  const double image = 0.5;  // the root of 0.25
  for (int k = 0; k < 600; ++k) {
    CAPTURE(k);
    CHECK(seen[std::size_t(k)] == Approx(k >= 120 && k < 140 ? 1 : k >= 260 && k < 280 ? image : 0).margin(kOwnPlace));
  }
  for (const double e : with_images(mirroring(0), kWaterAndGas, kGas_mm, {0, 19})) CHECK((e == 0 || e == Approx(1)));
}

TEST_CASE("the probe's face sends an image back again, and what the gas mirrors then is fainter by one round trip") {
  Settings settings = mirroring(0.25);
  settings.face_reflection = 0.36;
  const std::vector<double> seen = with_images(settings, kWaterAndGas, kGas_mm, {12, 14});
  // Lit samples 120 to 139, mirrored at 200, and at 200 again after a way of 200 back to the face.
  for (int k = 0; k < 600; ++k) {
    CAPTURE(k);
    const double expected = k >= 120 && k < 140 ? 1 : k >= 260 && k < 280 ? 0.5 : k >= 460 && k < 480 ? 0.5 * 0.6 : 0;
    CHECK(seen[std::size_t(k)] == Approx(expected).margin(1.5 * kOwnPlace));  // the third image of a place that is off
  }
  // From the face on, without end: gas at 4 mm.
  const std::vector<double> close = with_images(settings, kWaterAndGas, 4, {0, 4});
  for (int n = 1; n < 10; ++n) {
    CAPTURE(n);
    double power = 0;
    for (int k = 40 * n + 20; k < 40 * n + 38; ++k) power += std::pow(close[std::size_t(k)], 2) / 18;
    CHECK(std::sqrt(power) == Approx(0.5 * std::pow(0.6, n - 1)).epsilon(0.1));
  }
}

TEST_CASE("the surface of gas makes no image of itself, and water none of anything") {
  const std::vector<double> surface = with_images(mirroring(1), kWaterAndGas, kGas_mm, {19.8, 20.2});
  for (int k = 210; k < 600; ++k) CHECK(surface[std::size_t(k)] == 0);
  for (const double e : with_images(mirroring(1), plain_table(), 100, {12, 14})) CHECK((e == 0 || e == Approx(1)));
  const TissueTable weak{{{0, 1.5, 0, 0}, {1000, 7.8, 0, 0}}, {}};  // compact bone
  for (const double e : with_images(mirroring(1), weak, kGas_mm, {12, 14})) CHECK((e == 0 || e == Approx(1)));
}

TEST_CASE("an image is as bright wherever the gas lies between two samples") {
  const std::vector<double> whole = with_images(mirroring(1), kWaterAndGas, kGas_mm, {5, 15});
  for (const double beside : {0.01, 0.025, 0.04, 0.05}) {
    // Independent echoes of neighbouring samples would keep their power; equal ones add up to root 2 at most.
    const std::vector<double> seen = with_images(mirroring(1), kWaterAndGas, kGas_mm + beside, {5, 15});
    CHECK(seen[300] >= whole[300] * (1 - kOwnPlace));
    CHECK(seen[300] <= whole[300] * std::sqrt(2.0) * (1 + kOwnPlace));
  }
}

TEST_CASE("an image has travelled four times the way between the echo and the gas more than the echo") {
  TissueTable lossy = kWaterAndGas;
  for (TissueKnot& knot : lossy.knots) knot.absorption_db_cm_mhz = 0.7;
  Settings settings = mirroring(1);
  settings.absorption = true;
  const std::vector<double> seen = with_images(settings, lossy, kGas_mm, {0, 19}),
                            without = with_images(mirroring(1), kWaterAndGas, kGas_mm, {0, 19});
  for (const int k : {250, 300, 350}) {  // 5, 10 and 15 mm behind the gas
    const double away_cm = (k + 0.5) / 100 - kGas_mm / 10;
    CHECK(20 * std::log10(seen[std::size_t(k)] / without[std::size_t(k)]) ==
          Approx(-4 * 0.7 * settings.frequency_mhz * away_cm).margin(0.2));  // I is that of samples before the gas
  }
}
