// How work is shared out to the device: pictures are the same whatever the device takes at once, and what it takes not
// at all is said.

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "sim/gl/program.h"
#include "sim/gl/simulator.h"
#include "sim/gl/volume_sweep.h"
#include "tests/gl/test_body.h"
#include "tests/gl/test_context.h"

using namespace insonate;

namespace {

Stages<float> stages_of(const Probe& probe, const Settings& settings, const gl::Scheme& scheme, double depth_mm = 100) {
  const test::TestContext context;
  gl::Simulator simulator({}, scheme);
  simulator.set_volume(test::test_body(), read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml"));
  simulator.set_probe(probe, depth_mm);
  simulator.set_settings(settings);
  simulator.set_pose(test::on_the_skin(0, 9, 0));
  return simulator.read_stages();
}

// Of either way to white: by a fixed level, and by each frame's brightest pixel.
std::array<Settings, 2> both_whites(int width, int height) {
  Settings fixed = trainer_settings(3.5, 100);
  fixed.samples = 128;
  fixed.image_width = width;
  fixed.image_height = height;
  Settings of_frame = fixed;
  of_frame.reference_level = ReferenceLevel::frame_maximum;
  return {fixed, of_frame};
}

}  // namespace

TEST_CASE("work groups go into rows that a device takes, none of them empty") {
  const gl::Scheme scheme;
  CHECK(scheme.in_rows(0) == glm::ivec2(1, 1));
  CHECK(scheme.in_rows(1) == glm::ivec2(1, 1));
  CHECK(scheme.in_rows(65535) == glm::ivec2(65535, 1));
  CHECK(scheme.in_rows(65536) == glm::ivec2(32768, 2));
  CHECK(scheme.in_rows(262144) == glm::ivec2(52429, 5));  // the largest picture there is: 8192 x 8192
  CHECK(gl::Scheme{4}.in_rows(9) == glm::ivec2(3, 3));
  CHECK(gl::Scheme{4}.in_rows(10) == glm::ivec2(4, 3));
}

TEST_CASE("a picture of more work groups than go into a row is the same to the last bit") {
  for (const Settings& settings : both_whites(200, 150)) {
    const Probe probe = *find_probe("curvilinear");
    const Stages<float> at_once = stages_of(probe, settings, {});
    const Stages<float> in_rows = stages_of(probe, settings, {7});  // no divisor of the fan's blocks
    CHECK(at_once.grey.pixels == in_rows.grey.pixels);
    CHECK(at_once.inside.pixels == in_rows.inside.pixels);
    CHECK(at_once.fused.pixels == in_rows.fused.pixels);
    CHECK(*std::max_element(at_once.grey.pixels.begin(), at_once.grey.pixels.end()) > 100);
  }
}

TEST_CASE("a picture so small that the fan touches no pixel is black") {
  for (const Settings& settings : both_whites(2, 1)) {
    const Stages<float> stages = stages_of(*find_probe("curvilinear"), settings, {}, 160);
    CHECK(stages.inside.pixels == std::vector<std::uint8_t>{0, 0});
    CHECK(stages.grey.pixels == std::vector<std::uint8_t>{0, 0});
  }
}

TEST_CASE("a swept volume may have more rows of voxels than a device takes work groups") {
  const test::TestContext context;
  Sweep sweep;
  sweep.probe = *find_probe("linear");
  sweep.probe.lines = 4;
  sweep.depth_mm = 40;
  for (const double z : {-10.0, 10.0}) sweep.patient_from_plane.push_back({glm::dmat3(1), {0, 0, z}});
  const SweepValues values{3, 4, std::vector<float>(2 * 4 * 3, 0.5f)};
  Grid grid;  // 150,000 work groups of four rows each
  grid.size = {2, 600, 1000};
  grid.spacing = {1, 0.05, 0.015};
  grid.origin = {-0.5, 1, -7.5};
  gl::VolumeSweep converter;
  const Volume<float> got = gl::read_swept_volume(converter.convert(sweep, values, grid), grid);
  CHECK(std::ranges::all_of(got.voxels, [](float value) { return value == 0.5f; }));
}

TEST_CASE("more work groups than a device takes are refused in a sentence") {
  const test::TestContext context;
  const gl::Program program(gl::ShaderSources(), {"clutter_tail.comp"});
  GLint most = 0;
  glGetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, 1, &most);
  if (most < std::numeric_limits<GLint>::max())
    CHECK_THROWS_WITH(program.dispatch_groups(1, most + 1),
                      Catch::Contains("clutter_tail.comp: " + std::to_string(most + 1) + " work groups") &&
                          Catch::Contains("the device's limit of " + std::to_string(most)));
  CHECK_THROWS_AS(gl::Buffer(0, nullptr), std::invalid_argument);
}
