// Spatial compounding on the graphics card, beside the reference, and what it does to speckle.

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "sim/imaging/simulator.h"
#include "sim/model/compounding.h"
#include "sim/reference/reference.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/changed_simulator.h"
#include "tests/imaging/parity.h"
#include "tests/imaging/stage_parity.h"
#include "tests/imaging/test_body.h"
#include "tests/imaging/test_divisions.h"

using namespace insonate;

namespace {

Settings small_compounded(double frequency_mhz = 3.5, double depth_mm = 100) {
  Settings settings = trainer_settings(frequency_mhz, depth_mm);
  settings.samples = 200;
  settings.image_width = 150;
  settings.image_height = 120;
  settings.steering_angles = 3;
  settings.steering_deg = 10;
  settings.skipping = false;  // which the reference does not implement
  return settings;
}

Image<std::uint8_t> grey_of(const gl::Texture& texture) {
  Image<Rgba8> rgba(texture.width(), texture.height());
  texture.read(GL_RGBA, GL_UNSIGNED_BYTE, rgba.pixels.data(), rgba.pixels.size() * sizeof(Rgba8));
  Image<std::uint8_t> grey(rgba.width, rgba.height);
  std::ranges::transform(rgba.pixels, grey.pixels.begin(), [](const Rgba8& pixel) { return pixel[0]; });
  return grey;
}

void check_grey_inside(const Stages<double>& expected, const Image<std::uint8_t>& got) {
  std::vector<int> one, other;
  for (std::size_t i = 0; i < expected.grey.pixels.size(); ++i)
    if (expected.inside.pixels[i]) one.push_back(expected.grey.pixels[i]), other.push_back(got.pixels[i]);
  test::check_grey_of_waves(one, other);
}

}  // namespace

TEST_CASE("compounded pictures agree with the reference: every stage of the straight look, and the mean of all") {
  const test::TestContext context;
  const bool linear = GENERATE(true, false);
  Probe probe = *find_probe(linear ? "linear" : "curvilinear");
  probe.lines = 80;
  const double depth_mm = linear ? 60 : 110;
  Settings settings = small_compounded(linear ? 7.5 : 3.5, depth_mm);
  settings.noise_db = -80;  // seen at the end of the lines, and another in each look
  settings.steering_angles = linear ? 5 : 3;
  settings.ring_down = kUsualRingDown;
  settings.elevation_focus_mm = linear ? 30 : 0;
  const Pose pose = test::on_the_skin(0, linear ? 3 : 9, 12);
  const AcousticVolume body = test::test_body();
  const MediumField field = trilinear_field(body);
  const test::ReferenceStages reference =
      test::reference_stages(field, test::tissues(), probe, depth_mm, settings, pose);
  for (const gl::WorkDivision& division : {test::line_an_invocation(), test::line_per_group()}) {
    gl::Simulator simulator({}, division);
    simulator.set_volume(body, test::tissues());
    simulator.set_probe(probe, depth_mm);
    simulator.set_pose(pose);
    settings.exact_filter = test::own_filter_is_coarse();
    simulator.set_settings(settings);
    test::check_stages(reference, simulator.read_stages(), scan_lines(probe, depth_mm, settings.samples), settings);
  }
}

TEST_CASE(
    "in motion each frame replaces the oldest look, and at rest the picture is whole after as many as there are") {
  const test::TestContext context;
  const AcousticVolume body = test::test_body();
  Settings settings = small_compounded();
  settings.persistence = GENERATE(0.0, 0.5);
  const Probe& probe = *find_probe("curvilinear");
  gl::Simulator simulator;
  test::set_up(simulator, settings);
  const std::array poses{test::on_the_skin(0, 9, 0), test::on_the_skin(2, 9, 1), test::on_the_skin(3, 9, 2)};
  simulator.image_in_motion();
  const auto whole = [&](const Pose& pose, const Image<double>* before = nullptr) {
    return looks_reference(trilinear_field(body), test::tissues(), probe, 100, settings, std::vector<Pose>(3, pose),
                           before);
  };
  std::vector<Pose> of_looks(3, poses[0]);
  Image<double> before = whole(poses[0]).shown;
  for (const std::size_t frame : {std::size_t(1), std::size_t(2)}) {
    CAPTURE(frame);
    of_looks[frame - 1] = poses[frame];
    const long traversed = simulator.runs()[0];
    simulator.set_pose(poses[frame]);
    const Stages<double> expected =
        looks_reference(trilinear_field(body), test::tissues(), probe, 100, settings, of_looks, &before);
    check_grey_inside(expected, grey_of(simulator.image_in_motion()));
    CHECK(simulator.runs()[0] == traversed + 1);
    before = expected.shown;
  }
  simulator.image_in_motion();
  const Image<std::uint8_t> settled = grey_of(simulator.image_in_motion());
  const long runs = simulator.runs()[0];
  simulator.image_in_motion();
  CHECK(simulator.runs()[0] == runs);
  gl::Simulator fresh;
  test::set_up(fresh, settings);
  fresh.set_pose(poses.back());
  CHECK(settled.pixels == grey_of(fresh.image()).pixels);
  CHECK(settled.pixels == grey_of(simulator.image()).pixels);
  check_grey_inside(whole(poses.back()), settled);
}

TEST_CASE("a compounded picture after a change is the picture that a new simulator draws") {
  const std::function<void(Settings&)> changes[] = {
      [](Settings& s) { s.steering_angles = 5; },
      [](Settings& s) { s.steering_deg = 4; },
      [](Settings& s) { s.gain_db = 6; },
      [](Settings& s) { s.f_number = 5; },
      [](Settings& s) { s.noise_db = -70; },
      [](Settings& s) { s.ring_down = 1; },
      [](Settings& s) { s.fixed_level *= 1.1; },
      [](Settings& s) { s.face_reflection = 0.3; },
      [](Settings& s) { s.frequency_mhz = 5; },
      [](Settings& s) { s.reflection_length_mm = 1; },
      [](Settings& s) { s.waves = false; },
      [](Settings& s) { s.steering_angles = 3; },
      [](Settings& s) { s.waves = true; },
      [](Settings& s) { s.focused_beam = s.absorption = false; },
      [](Settings& s) { s.frequency_mhz = 2.5; },  // the carrier, by which looks differ
      [](Settings& s) { s.reference_level = ReferenceLevel::frame_maximum; },
      [](Settings& s) { s.speckle_reduction = 0.5, s.edge_enhancement = 1; },
      [](Settings& s) { s.steering_angles = 1; },
  };
  test::ChangedSimulator(small_compounded()).compare_with_new(changes);
}

TEST_CASE("looks see speckle of their own: the mean of three varies by less than a single one, by nearly 3^(1/2)") {
  // Of a mean of n independent Rayleigh envelopes, mean over deviation is 1.91 n^(1/2).
  const test::TestContext context;
  AcousticVolume block;
  block.grid.size = {2, 2, 2};
  block.grid.spacing = glm::dvec3(1000);
  block.grid.origin = {-500, 0, -500};
  block.voxels.assign(block.grid.count(), {60, 0});
  Settings settings = trainer_settings(3.5, 100);
  settings.absorption = settings.clutter = settings.electronic_noise = settings.reverberation = false;
  settings.face_reflection = 0;
  gl::Simulator simulator;
  simulator.set_volume(block, test::tissues());
  simulator.set_probe(*find_probe("curvilinear"), 100);
  Pose inside;
  inside.translation.y = 30;
  simulator.set_pose(inside);
  const auto snr = [&](int angles, double most_deg) {
    settings.steering_angles = angles;
    settings.steering_deg = most_deg;
    simulator.set_settings(settings);
    const Stages<float> stages = simulator.read_stages();
    double sum = 0, squares = 0, n = 0;
    for (int y = 150; y < 400; ++y)
      for (int x = 220; x < 420; ++x, ++n) {
        const double envelope = std::sqrt(stages.fused.at(x, y));
        sum += envelope, squares += envelope * envelope;
      }
    return sum / n / std::sqrt(squares / n - sum / n * sum / n);
  };
  const double one = snr(1, 8), three = snr(3, 8), close = snr(3, 1);
  std::printf("envelope's mean over deviation: one look %.3f, three %.3f, three within 1 degree %.3f\n", one, three,
              close);
  CHECK(one == Approx(1.91).margin(0.1));  // of bilinear means between samples, over some 600 grains
  CHECK(three / one > 1.55);
  CHECK(three / one < 1.85);
  CHECK(close < 0.9 * three);  // looks that hardly differ see nearly the same
}

TEST_CASE("looks of a probe in motion begin anew when there are fewer of them") {
  const test::TestContext context;
  const AcousticVolume body = test::test_body();
  const auto picture_after = [&](bool had_more) {
    gl::Simulator simulator;
    simulator.set_volume(body, test::tissues());
    simulator.set_probe(*find_probe("curvilinear"), 100);
    Settings settings = small_compounded();
    Pose pose = test::on_the_skin(0, 0, 0);
    simulator.set_pose(pose);
    if (had_more) {
      settings.steering_angles = 9;
      simulator.set_settings(settings);
      simulator.image();
      for (int frame = 0; frame < 7; ++frame) {  // the next look is the eighth
        pose.translation.x += 0.5;
        simulator.set_pose(pose);
        simulator.image_in_motion();
      }
      settings.steering_angles = 3;
    }
    simulator.set_settings(settings);
    simulator.set_pose(test::on_the_skin(0, 0, 0));
    simulator.image();
    pose = test::on_the_skin(0, 0, 0);
    pose.translation.x += 0.5;
    simulator.set_pose(pose);
    return grey_of(simulator.image_in_motion()).pixels;
  };
  CHECK(picture_after(true) == picture_after(false));
}
