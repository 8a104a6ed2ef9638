// Tests the shaders on media whose intensity and picture are known without a reference.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "sim/imaging/simulator.h"
#include "sim/reference/reference.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/test_divisions.h"
#include "tests/model/amplitudes.h"

using namespace insonate;

namespace {

/// Returns half a metre of one density, or of two that meet in the plane y = 0.
AcousticVolume medium(std::int16_t hu_before, std::int16_t hu_behind) {
  AcousticVolume volume;
  volume.grid.size = {10, 101, 10};
  volume.grid.spacing = {60, 10, 60};
  volume.grid.origin = {-270, -500, -270};
  for (int z = 0; z < volume.grid.size.z; ++z)
    for (int y = 0; y < volume.grid.size.y; ++y)
      for (int x = 0; x < volume.grid.size.x; ++x) volume.voxels.push_back({y < 50 ? hu_before : hu_behind, 0});
  return volume;
}

Pose at_y(double y_mm) {
  return {glm::dmat3(1.0), {0, y_mm, 0}};
}

}  // namespace

TEST_CASE("in a homogeneous medium sound is absorbed exactly, however many samples a line has") {
  constexpr double kHu = 60, kDepth_mm = 400, kFrequency_mhz = 3.5;
  const test::TestContext context;
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  Probe probe = *find_probe("linear");
  probe.lines = 4;
  const gl::WorkDivision division =
      GENERATE(test::line_an_invocation(), test::line_per_group(), test::line_per_group(128));
  CAPTURE(division.lines_that_fill, division.group);
  gl::Simulator simulator({}, division);
  simulator.set_volume(medium(std::int16_t(kHu), std::int16_t(kHu)), table);
  simulator.set_probe(probe, kDepth_mm);
  simulator.set_pose(at_y(-200));
  const double a = table.at(kHu).absorption_db_cm_mhz;
  for (const int samples : {1, 512, 2132, 8192}) {
    Settings settings = test::trainer_with_amplitudes(kFrequency_mhz, kDepth_mm);
    settings.samples = samples;
    settings.image_width = settings.image_height = 16;
    simulator.set_settings(settings);
    const Stages<float> stages = simulator.read_stages();
    const double dr = kDepth_mm / samples;
    double worst = 0;
    for (int k = 0; k < samples; ++k) {
      const double expected = std::pow(10.0, -a * kFrequency_mhz * (k + 0.5) * dr / 100);
      for (int line = 0; line < probe.lines; ++line) {
        worst = std::max(worst, std::abs(stages.intensity.at(line, k) / expected - 1));
        CHECK(stages.reflection.at(line, k) == 0);
      }
    }
    INFO(samples << " samples, I off by " << worst << " of itself at worst");
    CHECK(worst < 1e-5);  // the limit of the accuracy contract
  }
}

TEST_CASE("where the CT ends sound is absorbed, also without absorption, and nothing echoes") {
  constexpr double kDepth_mm = 100, kFrequency_mhz = 3.5, kEnd = -71;  // dB
  const test::TestContext context;
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  Probe probe = *find_probe("linear");
  probe.lines = 4;
  AcousticVolume volume = medium(60, 60);
  for (AcousticVoxel& voxel : volume.voxels) voxel.echogenicity_cdb = std::int16_t(100 * kEnd);
  gl::Simulator simulator;
  simulator.set_volume(volume, table);
  simulator.set_probe(probe, kDepth_mm);
  simulator.set_pose(at_y(-200));
  for (const bool waves : {false, true})
    for (const bool absorption : {false, true}) {
      Settings settings = waves ? trainer_settings(kFrequency_mhz, kDepth_mm)
                                : test::trainer_with_amplitudes(kFrequency_mhz, kDepth_mm);
      settings.absorption = absorption;
      settings.electronic_noise = false;
      simulator.set_settings(settings);
      const Stages<float> stages = simulator.read_stages();
      const Stages<double> reference =
          simulate_reference(trilinear_field(volume), table, probe, kDepth_mm, settings, at_y(-200));
      const double a =
          kEndAbsorption * std::pow(kEndless_db - kEnd, 2) + (absorption ? table.at(60).absorption_db_cm_mhz : 0);
      double worst = 0;
      for (int k = 0; k < stages.intensity.height; ++k) {
        const double expected =
            std::pow(10.0, -a * kFrequency_mhz * (k + 0.5) * kDepth_mm / stages.intensity.height / 100);
        for (int line = 0; line < probe.lines; ++line) {
          worst = std::max(worst, std::abs(stages.intensity.at(line, k) / expected - 1));
          worst = std::max(worst, std::abs(reference.intensity.at(line, k) / expected - 1));
        }
      }
      CHECK(worst < 1e-5);  // the limit of the accuracy contract
      CHECK(std::ranges::count(stages.grey.pixels, 0) == std::ssize(stages.grey.pixels));
    }
}

TEST_CASE("a probe in air, or held off the skin, shows its own face and nothing behind") {
  constexpr double kDepth_mm = 120;
  const test::TestContext context;
  gl::Simulator simulator;
  simulator.set_volume(medium(-1000, 60), read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml"));
  simulator.set_probe(*find_probe("linear"), kDepth_mm);
  const auto brightest_behind = [&](const Settings& settings, double air_mm, double from_mm) {
    simulator.set_settings(settings);
    simulator.set_pose(at_y(-5 - air_mm));  // air ends between voxels, 5 mm before the first voxel of the body
    const Stages<float> stages = simulator.read_stages();
    std::uint8_t brightest = 0;
    for (int y = 0; y < stages.grey.height; ++y)
      for (int x = 0; x < stages.grey.width; ++x)
        if (simulator.geometry().plane_mm(x, y).y > from_mm) brightest = std::max(brightest, stages.grey.at(x, y));
    return int(brightest);
  };
  const Settings paper = paper_settings(kDepth_mm, 512);
  Settings dry = test::trainer_with_amplitudes(7.5, kDepth_mm), with_gel = dry;
  dry.gel_mm = 0;
  for (Settings* settings : {&dry, &with_gel}) {
    settings->clutter = settings->electronic_noise = false;
    settings->face_reflection = 0;  // otherwise the gel's end would repeat through round trips in the gel
    settings->transmission_sigma_mm = 0;
  }
  CHECK(with_gel.gel_mm == 6);
  for (const double air_mm : {20.0, 300.0}) {
    CHECK(brightest_behind(paper, air_mm, 3) == 0);
    CHECK(brightest_behind(dry, air_mm, 3) == 0);
    CHECK(brightest_behind(with_gel, air_mm, 9) == 0);  // gel, and the smoothed echo of its end
  }
  CHECK(brightest_behind(paper, -20, 3) > 100);
  CHECK(brightest_behind(dry, -20, 3) > 100);
}

TEST_CASE("where half of the face is in the air there is no image under that half, and the other half's is whole") {
  // The skin's edge lies in the plane x = 0. Behind the air, from 40 mm on, is tissue again.
  constexpr double kDepth_mm = 80, kFace_mm = 3, kEdge_mm = 5;  // extents of beam, smoothing and CT voxels
  const auto body = [](bool whole) {
    AcousticVolume volume;
    volume.grid.size = {80, 100, 20};
    volume.grid.spacing = {1, 1, 4};
    volume.grid.origin = {-39.5, -5.5, -38};
    for (int z = 0; z < volume.grid.size.z; ++z)
      for (int y = 0; y < volume.grid.size.y; ++y)
        for (int x = 0; x < volume.grid.size.x; ++x)
          volume.voxels.push_back({std::int16_t(!whole && x >= 40 && y < 45 ? -1000 : 60), 0});
    return volume;
  };
  Probe probe = *find_probe("linear");
  probe.lines = 64;
  Settings settings = test::trainer_with_amplitudes(7.5, kDepth_mm);
  settings.gel_mm = 0;
  settings.clutter = settings.electronic_noise = false;
  settings.reflection_sigma_mm = settings.transmission_sigma_mm = 0;
  settings.image_width = settings.image_height = 120;
  settings.reference_level = ReferenceLevel::fixed;

  const test::TestContext context;
  gl::Simulator simulator;
  simulator.set_probe(probe, kDepth_mm);
  simulator.set_settings(settings);
  const auto drawn = [&](bool whole) {
    simulator.set_volume(body(whole), read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml"));
    return simulator.read_stages();
  };
  const Stages<float> half = drawn(false), full = drawn(true);
  int in_air = 0, on_skin = 0, brightest_in_air = 0, most_changed = 0, bright = 0;
  for (int y = 0; y < half.grey.height; ++y)
    for (int x = 0; x < half.grey.width; ++x) {
      const glm::dvec2 at = simulator.geometry().plane_mm(x, y);
      if (!half.inside.at(x, y) || at.y < kFace_mm) continue;
      if (at.x > kEdge_mm) ++in_air, brightest_in_air = std::max(brightest_in_air, int(half.grey.at(x, y)));
      if (at.x < -kEdge_mm) {
        ++on_skin, bright += full.grey.at(x, y) > 40;
        most_changed = std::max(most_changed, std::abs(int(half.grey.at(x, y)) - int(full.grey.at(x, y))));
      }
    }
  CHECK(in_air > 1000);
  CHECK(on_skin > 1000);
  CHECK(brightest_in_air == 0);
  CHECK(most_changed == 0);
  CHECK(bright > on_skin / 2);
}
