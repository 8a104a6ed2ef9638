// Tails of thin layers and repeats by the probe's face, against what can be worked out by hand.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/reference/reference.h"
#include "sim/reference/reverberation_reference.h"
#include "tests/accuracy/media.h"
#include "tests/model/amplitudes.h"

using namespace insonate;
using namespace insonate::test;

TEST_CASE("a thin layer draws a tail behind it, an echo each time that sound has crossed it twice more") {
  const TissueTable table{{{0, 1.0, 0, 0}, {1000, 11.0, 0, 0}}, {}};
  const ScanLines lines = one_line(60, 600);
  Settings settings = without_absorption(0.2);
  settings.reverberation = true;
  // Plates of 3 and 5 MRayl in 1 MRayl, at depths that samples meet in their middles; a strong one behind them.
  const auto echoes = [&](double first_mm, double thick_mm, double hu, double absorption) {
    TissueTable lossy = table;
    for (TissueKnot& knot : lossy.knots) knot.absorption_db_cm_mhz = absorption;
    settings.absorption = absorption > 0;
    const ReferenceScan scan = traverse_reference(
        [=](const glm::dvec3& p) {
          return Medium{p.y > first_mm && p.y < first_mm + thick_mm ? hu : 0.0, 0};
        },
        lossy, lines, settings, {});
    return std::pair(scan, reverberation_reference(scan.intensity, scan.reflection, lines, settings));
  };
  const auto area = [](const Image<double>& image, double depth_mm) {  // of what lies within 0.3 mm
    double sum = 0;
    for (int k = int((depth_mm - 0.3) / 0.1); k < int((depth_mm + 0.3) / 0.1); ++k) sum += image.at(0, k);
    return sum;
  };
  const double alpha = plain_alpha(0, 400);  // there and back within the plate: alpha^2 a round
  const auto [scan, tail] = echoes(20, 2, 400, 0);
  const double first = area(scan.reflection, 22);
  for (int n = 1; n <= 4; ++n)
    // What is left out counts 8 (kMinRound/alpha^2)^2 a round, 2e-4.
    CHECK(area(tail, 22 + 2 * n) == Approx(first * std::pow(alpha * alpha, n)).epsilon(1e-3));
  CHECK(area(tail, 23) == 0);
  CHECK(area(tail, 22) == 0);

  // Sound that crosses a lossy plate: 1 dB/(cm MHz) at 3.5 MHz over 4 mm more in each round; but for the width of both
  // echoes, l in all.
  const auto [lossy_scan, lossy_tail] = echoes(20, 2, 400, 1);
  const double loss = std::pow(10.0, -3.5 * 0.4 / 10);
  CHECK(area(lossy_tail, 24) == Approx(area(lossy_scan.reflection, 22) * alpha * alpha * loss).epsilon(0.1));

  // Weak plates ring, but nobody hears them; and the samples that show one interface do not ring with each other.
  CHECK(area(echoes(20, 2, 20, 0).second, 24) == 0);
  for (double echo : echoes(20, 100, 400, 0).second.pixels) CHECK(echo == 0);
  settings.reverberation = false;
  CHECK(area(echoes(20, 2, 400, 0).second, 24) == 0);
}

TEST_CASE("a repeat leaves the picture at the lines' end without a step") {
  Settings settings = without_absorption(1);
  settings.face_reflection = 1;
  Image<double> intensity(1, 40), reflection(1, 40);
  std::fill(intensity.pixels.begin(), intensity.pixels.end(), 1.0);
  reflection.at(0, 19) = 0.5;
  // The face, nearer or further, brings the repeat of sample 19 to either side of the end, behind sample 39.
  const auto last = [&](double position) {
    ScanLines lines = one_line(40, 40);
    lines.r_min_mm = position - 19 - 19.5;
    lines.r_max_mm = lines.r_min_mm + 40;
    return reverberation_reference(intensity, reflection, lines, settings).at(0, 39);
  };
  CHECK(last(39) > 0.1);
  for (const double end : {40.0, 41.0}) CHECK(last(end - 1e-6) == Approx(last(end + 1e-6)).margin(1e-5));
  CHECK(last(40) > 0.02);
  CHECK(last(41) == 0);
}

TEST_CASE("the probe's face repeats what straight lines meet, and nothing along steered ones") {
  Settings settings = without_absorption(1);
  settings.face_reflection = 1;
  Image<double> intensity(1, 60), reflection(1, 60);
  std::fill(intensity.pixels.begin(), intensity.pixels.end(), 1.0);
  reflection.at(0, 19) = 0.5;
  ScanLines lines = one_line(60, 60);
  const auto loudest = [&] {
    const Image<double> repeats = reverberation_reference(intensity, reflection, lines, settings);
    return *std::ranges::max_element(repeats.pixels);
  };
  CHECK(loudest() > 0.1);
  lines.fan.steering = 0.1;
  CHECK(loudest() == 0);
}

TEST_CASE("a surface that a slice's planes meet at different depths holds no sound between them") {
  Probe probe = *find_probe("linear");
  probe.lines = 8;
  Settings settings = test::trainer_with_amplitudes(5, 40);
  settings.image_width = settings.image_height = 16;
  settings.face_reflection = 0;
  settings.slice_thickness_mm = 5;
  REQUIRE((settings.reverberation && settings.slice_planes > 1));
  const auto stages = simulate_reference(
      [](const glm::dvec3& p) {
        return Medium{p.y + p.z > 20 ? 900.0 : 0.0, 0};
      },
      plain_table(), probe, 40, settings, {});
  CHECK(*std::max_element(stages.reflection.pixels.begin(), stages.reflection.pixels.end()) > 0.01);
  CHECK(*std::max_element(stages.repeated.pixels.begin(), stages.repeated.pixels.end()) == 0);
}

TEST_CASE("gas repeats at multiples of its depth, each time weaker by its echo and the face's reflection") {
  Probe probe = *find_probe("linear");
  probe.lines = 16;
  Settings settings = test::trainer_with_amplitudes(5, 40);
  settings.samples = 400;
  settings.reflection_length_mm = 0.2;
  settings.image_width = settings.image_height = 400;
  settings.blend = settings.reflection_sigma_mm = 0;
  settings.speckle = settings.absorption = settings.electronic_noise = settings.clutter = false;
  const auto echo_near = [&](double depth_mm, double hu_behind) {
    const auto stages = simulate_reference(
        [=](const glm::dvec3& p) {
          return Medium{p.y > 10.05 ? hu_behind : 0.0, 0};
        },
        plain_table(), probe, 40, settings, {});
    const ImageGeometry geometry = image_geometry(probe, 40, 400, 400);
    double sum = 0;
    for (int y = 0; y < 400; ++y)
      if (std::abs(geometry.plane_mm(200, y).y - depth_mm) < 1) sum += stages.fused.at(200, y);
    return sum;
  };
  const double alpha = std::pow(4.0 / 6.0, 2);  // of 1 against 5 MRayl
  settings.face_reflection = 0.1;
  const double first = echo_near(10.05, 400);
  CHECK(echo_near(20.1, 400) == Approx(0.1 * alpha * first).epsilon(0.01));
  CHECK(echo_near(30.15, 400) == Approx(0.01 * alpha * alpha * first).epsilon(0.01));
  CHECK(echo_near(25, 400) == 0);
  CHECK(echo_near(20.1, 1) < 1e-9);  // tissue's are not to be seen
  settings.face_reflection = 0;
  CHECK(echo_near(20.1, 400) == 0);
}
