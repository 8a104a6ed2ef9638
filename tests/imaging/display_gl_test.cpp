// The display of a picture: its filter, and the frame before in a picture in motion.

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "sim/core/hash.h"
#include "sim/imaging/simulator.h"
#include "sim/reference/display_reference.h"
#include "sim/reference/reference.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/changed_simulator.h"
#include "tests/imaging/test_body.h"

using namespace insonate;

namespace {

Settings small_filtered() {
  Settings settings = trainer_settings(3.5, 100);
  settings.samples = 128;
  settings.image_width = 140;
  settings.image_height = 110;
  settings.dynamic_range_db = 60;
  settings.edge_enhancement = 1.5;
  settings.speckle_reduction = 0.6;
  return settings;
}

Image<std::uint8_t> grey_of(const gl::Texture& texture) {
  Image<Rgba8> rgba(texture.width(), texture.height());
  texture.read(GL_RGBA, GL_UNSIGNED_BYTE, rgba.pixels.data(), rgba.pixels.size() * sizeof(Rgba8));
  Image<std::uint8_t> grey(rgba.width, rgba.height);
  std::ranges::transform(rgba.pixels, grey.pixels.begin(), [](const Rgba8& pixel) { return pixel[0]; });
  return grey;
}

/// Checks that at most one pixel in a thousand is off by more than a grey level: in the dark between grains the
/// scatterers' sums, which are whole numbers, decide (tests/imaging/parity.h).
void check_close(const Image<std::uint8_t>& expected, const Image<std::uint8_t>& got, double factor = 1) {
  REQUIRE(expected.pixels.size() == got.pixels.size());
  std::size_t off = 0;
  int worst = 0;
  for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
    const int error = std::abs(int(expected.pixels[i]) - int(got.pixels[i]));
    off += error > std::ceil(factor);
    worst = std::max(worst, error);
  }
  INFO(off << " pixels off, worst " << worst);
  CHECK(double(off) <= 0.001 * double(expected.pixels.size()));
  CHECK(worst <= 6 * factor);
}

}  // namespace

TEST_CASE("the display filter on the graphics card is the reference's") {
  const test::TestContext context;
  Settings settings = small_filtered();
  const int kind = GENERATE(0, 1, 2, 3, 4);
  if (kind == 1) settings.edge_enhancement = 0;
  if (kind == 2) settings.speckle_reduction = 0;
  if (kind == 3) settings.reference_level = ReferenceLevel::frame_maximum, settings.grey_map = GreyMap::s_curve;
  if (kind == 4)
    settings.waves = false, settings.frequency_mhz = 1.5;  // a window that is as wide as the fan is at its top
  CAPTURE(kind);
  gl::Simulator simulator;
  test::set_up(simulator, settings);
  const Stages<float> got = simulator.read_stages();
  Image<double> shown(got.shown.width, got.shown.height);
  std::ranges::copy(got.shown.pixels, shown.pixels.begin());
  const Image<std::uint8_t> expected = filtered_grey(shown, got.inside, settings, simulator.geometry().mm_per_pixel, 1);
  int most = 0;
  double change = 0;
  for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
    most = std::max(most, std::abs(int(expected.pixels[i]) - int(got.grey.pixels[i])));
    change += std::abs(255 * shown.pixels[i] - expected.pixels[i]) / double(expected.pixels.size());
  }
  CHECK(most <= 1);
  CHECK(change > 0.5);  // a filter that does nothing would agree as well
}

TEST_CASE("the whole filtered picture agrees with the reference") {
  const test::TestContext context;
  Settings settings = small_filtered();
  settings.skipping = false;
  gl::Simulator simulator;
  test::set_up(simulator, settings);
  const AcousticVolume body = test::test_body();
  const Stages<double> expected = simulate_reference(trilinear_field(body), test::tissues(), *find_probe("curvilinear"),
                                                     100, settings, test::on_the_skin(0, 9, 0));
  check_close(expected.grey, simulator.read_stages().grey, 1 + settings.edge_enhancement);
}

TEST_CASE("speckle is drawn to its mean, and an edge is raised: the filter in numbers") {
  // Speckle alone has v near v_0, so that s takes about s of its deviation; a step far above it has w near 0.
  Image<double> shown(200, 200, 0.5);
  Image<std::uint8_t> inside(200, 200, 1);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x) {
      const double grain = 2.0 * unit_float(hash(std::uint32_t(x), std::uint32_t(y))) - 1;
      shown.at(x, y) = 0.5 + 5.57 / 60 * std::sqrt(3.0) * grain;  // evenly distributed, as wide as speckle
      if (x >= 150) shown.at(x, y) = 0.9;
      if (x >= 100 && x < 150) shown.at(x, y) = 0.1;
    }
  Settings settings = small_filtered();
  settings.dynamic_range_db = 60;
  const auto filtered = [&](double edge, double reduction) {
    settings.edge_enhancement = edge;
    settings.speckle_reduction = reduction;
    return filtered_grey(shown, inside, settings, 0.4, 1);
  };
  const auto deviation = [&](const Image<std::uint8_t>& grey) {
    double sum = 0, squares = 0, n = 0;
    for (int y = 20; y < 180; ++y)
      for (int x = 20; x < 80; ++x, ++n) sum += grey.at(x, y), squares += grey.at(x, y) * grey.at(x, y);
    return std::sqrt(squares / n - sum / n * sum / n);
  };
  const Image<std::uint8_t> plain = filtered(0, 0), smooth = filtered(0, 1), sharp = filtered(1, 0);
  CHECK(deviation(plain) == Approx(255 * 5.57 / 60).epsilon(0.02));
  CHECK(deviation(smooth) < 0.35 * deviation(plain));
  CHECK(deviation(sharp) < 1.25 * deviation(plain));
  // Beside the step from 0.1 to 0.9 the unsharp mask overshoots on both sides; away from it nothing changes.
  CHECK(plain.at(149, 100) == 26);
  CHECK(sharp.at(149, 100) < 5);
  CHECK(sharp.at(150, 100) == 255);
  CHECK(sharp.at(125, 100) == 26);
  CHECK(smooth.at(149, 100) == Approx(26).margin(6));
}

TEST_CASE("the filter and the frame before run no stage that they do not need") {
  Settings plain = small_filtered();
  plain.edge_enhancement = plain.speckle_reduction = 0;
  test::ChangedSimulator changed(plain);
  Settings& s = changed.settings;
  CHECK(changed.after([&] { s.persistence = 0.5; }) == "");
  CHECK(changed.after([&] { s.edge_enhancement = 1; }) == "46");
  CHECK(changed.after([&] { s.edge_enhancement = 2; }) == "6");
  CHECK(changed.after([&] { s.speckle_reduction = 0.5; }) == "6");
  CHECK(changed.after([&] { s.gain_db = 3; }) == "46");
  CHECK(changed.after([&] { s.edge_enhancement = s.speckle_reduction = 0; }) == "4");
  s.reference_level = ReferenceLevel::frame_maximum;
  CHECK(changed.after([&] { s.speckle_reduction = 0.5; }) == "456");
  CHECK(changed.after([&] { s.dynamic_range_db = 50; }) == "56");
}

TEST_CASE("a filtered picture after a change is the picture that a new simulator draws") {
  const std::function<void(Settings&)> changes[] = {
      [](Settings& s) { s.edge_enhancement = 3; },
      [](Settings& s) { s.speckle_reduction = 0; },
      [](Settings& s) { s.edge_enhancement = 0; },
      [](Settings& s) { s.persistence = 0.7; },
      [](Settings& s) { s.speckle_reduction = 1; },
      [](Settings& s) { s.frequency_mhz = 6; },
      [](Settings& s) { s.dynamic_range_db = 45; },
      [](Settings& s) { s.grey_map = GreyMap::soft; },
      [](Settings& s) { s.reference_level = ReferenceLevel::frame_maximum; },
      [](Settings& s) { s.image_width = 80; },
      [](Settings& s) { s.gain_db = 5; },
      [](Settings& s) { s.waves = false, s.focused_beam = false, s.absorption = false; },
      [](Settings& s) { s.frequency_mhz = 2; },
      [](Settings& s) { s.persistence = 0, s.speckle_reduction = 0; },
  };
  test::ChangedSimulator(small_filtered()).compare_with_new(changes);
}

TEST_CASE("a picture in motion holds the share of the frame before, and at rest nothing of it") {
  const test::TestContext context;
  const AcousticVolume body = test::test_body();
  Settings settings = test::exact_as_needed(small_filtered());
  settings.skipping = false;
  settings.persistence = 0.6;
  settings.edge_enhancement = GENERATE(0.0, 1.0);
  settings.speckle_reduction = 0;
  const Probe& probe = *find_probe("curvilinear");
  gl::Simulator simulator;
  test::set_up(simulator, settings);
  const std::array poses{test::on_the_skin(0, 9, 0), test::on_the_skin(2, 9, 1), test::on_the_skin(5, 8, 3)};
  Image<double> before;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    CAPTURE(i);
    const Stages<double> expected = looks_reference(trilinear_field(body), test::tissues(), probe, 100, settings,
                                                    {&poses[i], 1}, i > 0 ? &before : nullptr);
    simulator.set_pose(poses[i]);
    check_close(expected.grey, grey_of(simulator.image_in_motion()), 1 + settings.edge_enhancement);
    before = expected.shown;
  }
  const auto of_one_pose = [&](const Settings& as) {
    gl::Simulator fresh;
    test::set_up(fresh, as);
    fresh.set_pose(poses.back());
    return grey_of(fresh.image());
  };
  CHECK(grey_of(simulator.image_in_motion()).pixels == of_one_pose(settings).pixels);
  // What it begins with after a change of anything but the pose, or asked for the picture of a probe at rest, is whole.
  simulator.set_pose(poses.front());
  simulator.image_in_motion();
  simulator.set_pose(poses.back());
  simulator.image_in_motion();
  settings.gain_db = 3;
  simulator.set_settings(settings);
  CHECK(grey_of(simulator.image_in_motion()).pixels == of_one_pose(settings).pixels);
  simulator.set_pose(poses.front());
  simulator.image_in_motion();
  simulator.set_pose(poses.back());
  CHECK(grey_of(simulator.image()).pixels == of_one_pose(settings).pixels);
}
