// Tests what every simulator refuses: poses, probes and depths from which no picture can be made.

#include <catch2/catch.hpp>

#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sim/imaging/simulator.h"
#include "sim/imaging/view_limits.h"
#include "sim/wein/wein_simulator.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/test_sweeps.h"

using namespace insonate;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInfinite = std::numeric_limits<double>::infinity();

/// Returns each wrong pose with the expected part of its error message.
std::vector<std::pair<Pose, std::string>> wrong_poses() {
  return {{{glm::dmat3(1.0), {kNaN, 0, 0}}, "not finite"},
          {{glm::dmat3(1.0), {0, kInfinite, 0}}, "not finite"},
          {{glm::dmat3(kNaN), {}}, "not finite"},
          {{glm::dmat3(1.01), {}}, "not orthonormal"},
          {{glm::dmat3(1, 0, 0, 0.1, 1, 0, 0, 0, 1), {}}, "not orthonormal"},
          {{glm::dmat3(0.0), {}}, "singular"},
          {{glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, 1), {}}, "mirrors"},
          {{glm::dmat3(1.0), {0, -1e9, 0}}, "1e+09 mm"}};
}

Settings few_pixels() {
  Settings settings = trainer_settings(3.5, test::kDepth_mm);
  settings.samples = 100;
  settings.image_width = settings.image_height = 40;
  settings.reflection_length_mm = 2;
  return settings;
}

gl::Simulator with_a_picture() {
  gl::Simulator simulator;
  simulator.set_volume(test::test_body(), test::tissues());
  simulator.set_probe(test::small_probe("curvilinear"), test::kDepth_mm);
  simulator.set_settings(few_pixels());
  simulator.set_pose(test::on_the_skin(0, 9, 0));
  return simulator;
}

}  // namespace

TEST_CASE("poses of which no picture can be made are refused, and those before stay") {
  const test::TestContext context;
  gl::Simulator simulator = with_a_picture();
  const auto before = simulator.read_stages().grey.pixels;
  WeinSettings wein_settings;
  wein_settings.image_width = wein_settings.image_height = 40;
  gl::WeinSimulator wein(test::test_body(), test::small_probe("curvilinear"), test::kDepth_mm, wein_settings);
  gl::SweepSimulator sweeps;
  for (const auto& [pose, why] : wrong_poses()) {
    CAPTURE(why);
    CHECK_THROWS_WITH(simulator.set_pose(pose), Catch::StartsWith("simulator: the pose: ") && Catch::Contains(why));
    CHECK(simulator.read_stages().grey.pixels == before);
    const std::vector<Pose> three = {test::on_the_skin(0, 9, 0), pose, test::on_the_skin(1, 9, 0)};
    CHECK_THROWS_WITH(wein.simulate(three), Catch::StartsWith("Wein simulator: the pose: ") && Catch::Contains(why));
    CHECK_THROWS_AS(wein.similarity(three), std::invalid_argument);
    CHECK_THROWS_AS(wein.read_stages(pose), std::invalid_argument);
    Sweep sweep = test::by_hand();
    sweep.patient_from_plane[5] = pose;
    CHECK_THROWS_WITH(sweeps.set_sweep(sweep), Catch::StartsWith("sweep simulator: ") && Catch::Contains(why));
  }
  CHECK(wein.count(gl::WeinStage::traverse).runs == 0);
  // Rounding errors are accepted, and so is a CT whose origin is as far away as its reader accepts.
  CHECK_NOTHROW(simulator.set_pose({glm::dmat3(1.00001), {1e6, -1e6, 1.1e6}}));
}

TEST_CASE("probes and depths beyond their ranges are refused, and those before stay") {
  const test::TestContext context;
  gl::Simulator simulator = with_a_picture();
  const auto before = simulator.read_stages().grey.pixels;
  const auto refused = [&](const Probe& probe, double depth_mm, const char* why) {
    CAPTURE(why);
    CHECK_THROWS_WITH(simulator.set_probe(probe, depth_mm), Catch::StartsWith("simulator: ") && Catch::Contains(why));
    CHECK_THROWS_WITH(gl::WeinSimulator(test::test_body(), probe, depth_mm, WeinSettings{}), Catch::Contains(why));
    const Sweep sweep{probe, depth_mm, {test::on_the_skin(0, 9, 0), test::on_the_skin(0, 9, 5)}};
    CHECK_THROWS_WITH(gl::SweepSimulator().set_sweep(sweep), Catch::Contains(why));
    CHECK(simulator.read_stages().grey.pixels == before);
  };
  const Probe good = test::small_probe("curvilinear");
  refused(good, 0, "depth in mm is 0; give a number from 0.1 to 1000.");
  refused(good, 1001, "depth in mm is 1001");
  refused(good, kNaN, "depth in mm is nan");
  Probe probe = good;
  probe.lines = 0;
  refused(probe, 100, "number of scan lines is 0; give a number from 1 to 4096.");
  probe = good;
  probe.radius_mm = kInfinite;
  refused(probe, 100, "radius in mm is inf");
  probe = good;
  probe.field_of_view_deg = 360;
  refused(probe, 100, "field of view in degrees is 360");
  probe = good;
  probe.aperture_mm = 0;
  refused(probe, 100, "widest aperture in mm is 0");
  probe = test::small_probe("linear");
  probe.width_mm = -40;
  refused(probe, 100, "width in mm is -40");
}

TEST_CASE("model W's settings beyond their ranges are refused by name") {
  const test::TestContext context;
  WeinSettings settings;
  settings.samples = 0;
  CHECK_THROWS_WITH(gl::WeinSimulator(test::test_body(), test::small_probe("linear"), test::kDepth_mm, settings),
                    Catch::StartsWith("Wein simulator: 'samples' is 0"));
}
