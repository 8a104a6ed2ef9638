// Clutter from the body wall (sim/model/noise.h), against what can be worked out by hand.

#include <catch2/catch.hpp>

#include <cmath>

#include "sim/reference/clutter_reference.h"
#include "sim/reference/reference.h"
#include "tests/accuracy/media.h"

using namespace insonate;
using namespace insonate::test;

namespace {

constexpr int kLines = 10, kSamples = 80;

struct Lines {
  ScanLines lines;
  Settings settings;
  Stages<double> stages;

  Lines() {
    lines.lines.resize(kLines);
    lines.samples = kSamples;
    lines.r_max_mm = kSamples * 0.3;
    settings = trainer_settings(3.5, lines.r_max_mm);
    settings.reflection_length_mm = 0.6;
    stages.wave_re = stages.wave_im = stages.intensity = Image<double>(kLines, kSamples);
    for (double& intensity : stages.intensity.pixels) intensity = 0.5;
  }
  WallClutter clutter() const { return wall_clutter_reference(stages, lines, settings); }
};

}  // namespace

TEST_CASE("two layers return to the face and are met again at the sums of their depths") {
  Lines scan;
  for (int line = 0; line < kLines; ++line) {
    scan.stages.wave_re.at(line, 10) = 0.003;
    scan.stages.wave_im.at(line, 30) = 0.002;
  }
  // Samples lie at (k + 1/2) 0.3 mm.
  const WallClutter clutter = scan.clutter();
  const double a = 9e-6, b = 4e-6, weight = kWallReturn * 0.5 / 2;
  for (int k = 0; k < kSamples; ++k) {
    double expected = 0;
    if (k == 20 || k == 21) expected = a * a;      // the first layer twice
    if (k == 40 || k == 41) expected = 2 * a * b;  // one and the other, in both orders
    if (k == 60 || k == 61) expected = b * b;
    INFO("sample " << k);
    CHECK(clutter.most.at(0, k) == Approx(weight * expected).epsilon(1e-4).margin(1e-22));
    CHECK(clutter.at(3, k) == Approx(weight * expected).epsilon(1e-4).margin(1e-22));
  }
}

TEST_CASE("gas and bone count as a layer of fat and muscle, and the haze does not get into shadows") {
  Lines scan;
  for (int line = 0; line < kLines; ++line) scan.stages.wave_re.at(line, 10) = 0.003;
  const double of_wall = scan.clutter().at(0, 20);
  scan.stages.wave_re.at(4, 30) = 0.5;
  const WallClutter with_gas = scan.clutter();
  const double of_gas = kLayerShare * 0.25 / kLines;  // instead of 0.25 / kLines
  CHECK(with_gas.at(0, 40) == Approx(kWallReturn * 0.5 * 9e-6 * of_gas).epsilon(1e-3));
  for (int k = 31; k < kSamples; ++k) scan.stages.intensity.at(4, k) = 0.005;  // 40 dB less
  scan.stages.wave_re.at(4, 30) = 0;
  for (int line = 0; line < kLines; ++line) scan.stages.wave_re.at(line, 25) = 0.003;
  const WallClutter shadowed = scan.clutter();
  CHECK(shadowed.at(0, 36) == Approx(of_wall * 2).epsilon(1e-3));
  CHECK(shadowed.at(4, 36) == Approx(of_wall * 2 * 1e-4 / 0.90001).epsilon(1e-3));
}

TEST_CASE("behind a layered wall the front of a bladder is hazy, and its middle is black") {
  Probe probe = *find_probe("curvilinear");
  probe.lines = 48;
  constexpr double kDepth_mm = 120, kWall_mm = 24;
  Settings settings = trainer_settings(probe.frequency_mhz, kDepth_mm);
  settings.samples = 200;
  settings.reflection_length_mm = 2 * kDepth_mm / settings.samples;
  settings.slice_planes = 1;
  settings.electronic_noise = false;
  settings.image_width = 160, settings.image_height = 120;
  TissueTable table = plain_table();
  table.knots = {{-100, 1.38, 0.5, 0}, {0, 1.48, 0.02, 0}, {60, 1.65, 0.5, 0}};
  const auto wall_and_urine = [](const glm::dvec3& p) {
    const double depth = p.y;
    if (depth > kWall_mm) return Medium{0, kMinEchogenicity_db};
    return std::fmod(depth, 6) < 1.5 ? Medium{-100, 0} : Medium{60, 0};
  };
  const auto mean_db = [&](double from_mm, double to_mm) {
    const auto stages = simulate_reference(wall_and_urine, table, probe, kDepth_mm, settings, {});
    const ImageGeometry geometry = image_geometry(probe, kDepth_mm, settings.image_width, settings.image_height);
    double sum = 0, count = 0;
    for (int y = 0; y < settings.image_height; ++y)
      for (int x = 0; x < settings.image_width; ++x)
        if (const glm::dvec2 p = geometry.plane_mm(x, y); std::abs(p.x) < 12 && p.y > from_mm && p.y < to_mm)
          sum += stages.fused.at(x, y), ++count;
    return 10 * std::log10(std::max(sum / count, 1e-30));
  };
  const double wall = mean_db(14, 18), front = mean_db(28, 32), middle = mean_db(60, 64), back = mean_db(100, 104);
  // Lediju et al. (Ultrasonic Imaging 30, 2008): 0 to -30 dB relative to the mean of the bladder's wall.
  CHECK(front - wall < -10);
  CHECK(front - wall > -40);
  CHECK(middle < front - 15);
  CHECK(back < middle - 30);  // nothing returns a third time
  settings.clutter = false;
  CHECK(mean_db(28, 32) < -200);
}
