// The GLSL pipeline against the double-precision reference, stage by stage. Tolerances are those of the model's
// accuracy contract.

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "sim/core/hash.h"
#include "sim/gl/headless_context.h"
#include "sim/gl/simulator.h"
#include "sim/reference/reference.h"
#include "tests/gl/test_body.h"

using namespace insonate;

namespace {

struct Worst {
  double error = 0;
  int x = 0, y = 0;
  double expected = 0, got = 0;
};

// The worst disagreement, as a multiple of what is tolerated at that place.
Worst worst(const Image<double>& expected, const Image<float>& got, const Image<double>& tolerated) {
  REQUIRE(expected.pixels.size() == got.pixels.size());
  Worst found;
  for (int y = 0; y < expected.height; ++y)
    for (int x = 0; x < expected.width; ++x) {
      REQUIRE(std::isfinite(got.at(x, y)));
      const double error = std::abs(expected.at(x, y) - double(got.at(x, y))) / tolerated.at(x, y);
      if (error > found.error) found = {error, x, y, expected.at(x, y), got.at(x, y)};
    }
  return found;
}

std::string told(const char* what, const Worst& w) {
  char text[200];
  std::snprintf(text, sizeof text, "%s: worst %.3g of the tolerance at (%d, %d): reference %.9g, GLSL %.9g", what,
                w.error, w.x, w.y, w.expected, w.got);
  return text;
}

// Where the tissue table is steep, as at the foot of gas's ramp, rounding alone decides a sample's impedance: nobody
// can ask single precision for more there than it can hold. From a line's start to the filter's weights a coordinate in
// [0, 1] is rounded six times, each by up to 3e-8 of the body's 160 mm: 3e-5 mm in all. Filtering adds up eight
// products of values around 1000 HU, each rounded by 6e-8: 2e-4 HU. References over fields that are wrong by as much,
// at random, tell what that can change.
MediumField as_single_precision_knows_it(const MediumField& field, std::uint32_t seed) {
  constexpr double kPositionMm = 3e-5, kHu = 2e-4;
  return [&field, seed, count = std::uint32_t(0)](const glm::dvec3& p) mutable {
    const auto random = [&] { return 2.0 * unit_float(hash(seed, count++)) - 1.0; };
    const glm::dvec3 jitter(random(), random(), random());
    Medium medium = field(p + kPositionMm * jitter);
    medium.hu += kHu * random();
    return medium;
  };
}

void check_parity(const Probe& probe, double depth_mm, const Settings& settings, const Pose& pose) {
  const gl::HeadlessContext context;
  const AcousticVolume body = test::test_body();
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  gl::Simulator simulator;
  simulator.set_volume(body, table);
  simulator.set_probe(probe, depth_mm);
  simulator.set_settings(settings);
  simulator.set_pose(pose);
  const Stages<float> got = simulator.read_stages();
  const MediumField field = trilinear_field(body);
  const Stages<double> expected = simulate_reference(field, table, probe, depth_mm, settings, pose);
  std::array<Stages<double>, 4> uncertain;
  for (std::uint32_t i = 0; i < uncertain.size(); ++i)
    uncertain[i] = simulate_reference(as_single_precision_knows_it(field, i), table, probe, depth_mm, settings, pose);

  const auto tolerance = [&](Image<double> Stages<double>::*stage, auto&& basic) {
    Image<double> tolerated = expected.*stage;
    for (std::size_t i = 0; i < tolerated.pixels.size(); ++i) {
      const double value = (expected.*stage).pixels[i];
      tolerated.pixels[i] = basic(value);
      for (const Stages<double>& other : uncertain) tolerated.pixels[i] += std::abs((other.*stage).pixels[i] - value);
    }
    return tolerated;
  };

  // I: 1e-4 relative, or 1e-10 below 1e-6.
  const Worst intensity =
      worst(expected.intensity, got.intensity,
            tolerance(&Stages<double>::intensity, [](double value) { return 1e-4 * std::max(value, 1e-6); }));
  INFO(told("I", intensity));
  CHECK(intensity.error < 1);

  const double brightest = *std::max_element(expected.reflection.pixels.begin(), expected.reflection.pixels.end());
  REQUIRE(brightest > 0);
  const auto of_brightest = [&](double) { return 1e-4 * brightest; };
  const Worst reflection =
      worst(expected.reflection, got.reflection, tolerance(&Stages<double>::reflection, of_brightest));
  INFO(told("R", reflection));
  CHECK(reflection.error < 1);
  const Worst beam =
      worst(expected.reflection_beam, got.reflection_beam, tolerance(&Stages<double>::reflection_beam, of_brightest));
  INFO(told("R behind the beam", beam));
  CHECK(beam.error < 1);

  // The envelope of speckle passes through 0, so its error is measured against its mean of 1.
  const Worst speckle =
      worst(expected.speckle, got.speckle, tolerance(&Stages<double>::speckle, [](double) { return 1e-3; }));
  INFO(told("S", speckle));
  CHECK(speckle.error < 1);

  REQUIRE(expected.inside.pixels == got.inside.pixels);
  std::size_t inside = 0, off_by_more_than_1 = 0;
  int worst_grey = 0;
  double mean = 0;
  for (std::size_t i = 0; i < expected.grey.pixels.size(); ++i) {
    if (!expected.inside.pixels[i]) continue;
    const int error = std::abs(int(expected.grey.pixels[i]) - int(got.grey.pixels[i]));
    worst_grey = std::max(worst_grey, error);
    off_by_more_than_1 += error > 1;
    mean += expected.grey.pixels[i];
    ++inside;
  }
  INFO("grey: " << off_by_more_than_1 << " of " << inside << " pixels off by more than 1, worst " << worst_grey);
  CHECK(double(off_by_more_than_1) <= 0.001 * double(inside));
  CHECK(worst_grey <= 2);
  CHECK(mean / double(inside) > 10);  // a black picture would agree as well
}

Settings small(Settings settings) {
  settings.samples = 300;
  settings.image_width = 200;
  settings.image_height = 160;
  return settings;
}

}  // namespace

TEST_CASE("GLSL agrees with the reference: curvilinear probe, everything on") {
  Probe probe = *find_probe("curvilinear");
  probe.lines = 96;
  check_parity(probe, 120, small(trainer_settings(3.5, 120)), test::on_the_skin(0, 9, 12));
}

TEST_CASE("GLSL agrees with the reference: linear probe, wide box beam") {
  Probe probe = *find_probe("linear");
  probe.lines = 80;
  Settings settings = small(trainer_settings(7.5, 60));
  settings.beam_window = BeamWindow::box;
  settings.beam_lines = 11;
  settings.transmission_sigma_mm = 1.5;
  check_parity(probe, 60, settings, test::on_the_skin(-10, 1, -8));
}

TEST_CASE("GLSL agrees with the reference: the paper's own mode") {
  Probe probe = *find_probe("curvilinear");
  probe.lines = 64;
  Settings settings = small(paper_settings(110, 300));
  settings.speckle = false;
  check_parity(probe, 110, settings, test::on_the_skin(5, 12, 0));
}
