// Tests how work is divided among GPU threads: pictures do not depend on how much the device takes at once, and work
// that it cannot take at all is refused with a message.

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "sim/core/hash.h"
#include "sim/gl/program.h"
#include "sim/imaging/fan_layout.h"
#include "sim/imaging/simulator.h"
#include "sim/imaging/sweep_conversion.h"
#include "sim/wein/pixel_table.h"
#include "sim/wein/wein_simulator.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/test_body.h"

using namespace insonate;

namespace {

Stages<float> stages_of(const Probe& probe, const Settings& settings, const gl::WorkDivision& division,
                        double depth_mm = 100) {
  const test::TestContext context;
  gl::Simulator simulator({}, division);
  simulator.set_volume(test::test_body(), read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml"));
  simulator.set_probe(probe, depth_mm);
  simulator.set_settings(settings);
  simulator.set_pose(test::on_the_skin(0, 9, 0));
  return simulator.read_stages();
}

// Returns settings for both kinds of white: a fixed level, and the frame's brightest pixel.
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
  gl::WorkDivision division, in_fours;
  in_fours.most_groups = 4;
  CHECK(division.in_rows(0) == glm::ivec2(1, 1));
  CHECK(division.in_rows(1) == glm::ivec2(1, 1));
  CHECK(division.in_rows(65535) == glm::ivec2(65535, 1));
  CHECK(division.in_rows(65536) == glm::ivec2(32768, 2));
  CHECK(division.in_rows(262144) == glm::ivec2(52429, 5));  // the largest possible picture: 8192 x 8192
  CHECK(in_fours.in_rows(9) == glm::ivec2(3, 3));
  CHECK(in_fours.in_rows(10) == glm::ivec2(4, 3));
}

TEST_CASE("a picture of more work groups than go into a row is the same to the last bit") {
  for (const Settings& settings : both_whites(200, 150)) {
    const Probe probe = *find_probe("curvilinear");
    const Stages<float> at_once = stages_of(probe, settings, {});
    gl::WorkDivision sevens;  // does not divide the fan's blocks evenly
    sevens.most_groups = 7;
    const Stages<float> in_rows = stages_of(probe, settings, sevens);
    CHECK(at_once.grey.pixels == in_rows.grey.pixels);
    CHECK(at_once.inside.pixels == in_rows.inside.pixels);
    CHECK(at_once.fused.pixels == in_rows.fused.pixels);
    CHECK(*std::max_element(at_once.grey.pixels.begin(), at_once.grey.pixels.end()) > 100);

    const ScanLines lines = scan_lines(probe, 100, settings.samples);
    const gl::FanLayout fan(probe, 100, lines, 200, 150), fan_in_rows(probe, 100, lines, 200, 150, sevens);
    CHECK(fan_in_rows.blocks.size() > fan.blocks.size());
    CHECK(fan_in_rows.pixels_in_blocks() == fan.pixels_in_blocks());
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
  const std::vector<float> values(2 * 4 * 3, 0.5f);
  Grid grid;  // 150,000 work groups of four rows each
  grid.size = {2, 600, 1000};
  grid.spacing = {1, 0.05, 0.015};
  grid.origin = {-0.5, 1, -7.5};
  gl::SweepConversion conversion;
  conversion.lay_out(grid);
  conversion.convert(sweep, {0, 2}, gl::TexelBuffer(GL_R32F, values.size(), values.data()), 3);
  const Volume<float> got = conversion.read();
  CHECK(std::ranges::all_of(got.voxels, [](float value) { return value == 0.5f; }));
}

TEST_CASE("more work groups than a device takes are refused in a sentence") {
  const test::TestContext context;
  const gl::Program program(gl::ShaderSources(), {"imaging/clutter_tail.comp"});
  GLint most = 0;
  glGetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, 1, &most);
  if (most < std::numeric_limits<GLint>::max())
    CHECK_THROWS_WITH(program.dispatch_groups(1, most + 1),
                      Catch::Contains("clutter_tail.comp: " + std::to_string(most + 1) + " work groups") &&
                          Catch::Contains("the device's limit of " + std::to_string(most)));
  CHECK_THROWS_AS(gl::Buffer(0, nullptr), std::invalid_argument);
}

TEST_CASE("pictures are the same to the last bit whatever lines a work group traverses") {
  const Probe probe = *find_probe("curvilinear");
  Settings settings = both_whites(200, 150)[0];  // every effect on
  settings.reverberation = settings.clutter = true;
  gl::WorkDivision eight, wide;
  eight.group = 8;
  const Stages<float> expected = stages_of(probe, settings, eight);
  for (const int group : {4, 32, 64}) {
    CAPTURE(group);
    wide.group = group;
    const Stages<float> got = stages_of(probe, settings, wide);
    CHECK(got.grey.pixels == expected.grey.pixels);
    CHECK(got.fused.pixels == expected.fused.pixels);
    CHECK(got.intensity.pixels == expected.intensity.pixels);
  }
}

TEST_CASE("model W's pictures are so too, and its similarities but for how their sums are rounded") {
  const test::TestContext context;
  const AcousticVolume body = test::test_body();
  Probe probe = *find_probe("curvilinear");
  probe.lines = 61;  // not a multiple of any group
  WeinSettings settings;
  settings.samples = 91;  // odd, so that a line is not made of whole pairs
  settings.image_width = 72;
  settings.image_height = 60;
  std::vector<Pose> poses;
  for (int i = 0; i < 21; ++i) poses.push_back(test::on_the_skin(i - 10.0, 9, i));
  Image<float> ultrasound(settings.image_width, settings.image_height);
  for (std::size_t i = 0; i < ultrasound.pixels.size(); ++i) ultrasound.pixels[i] = unit_float(hash(std::uint32_t(i)));

  struct Shared {
    int group, images_per_invocation;
  };
  const auto drawn = [&](const Shared& shared, int patch) {
    gl::WorkDivision division;
    division.group = shared.group;
    division.images_per_invocation = shared.images_per_invocation;
    settings.similarity_patch = patch;
    gl::WeinSimulator simulator(body, probe, 100, settings, {}, division);
    simulator.set_ultrasound(ultrasound);
    const gl::Texture& grid = simulator.simulate(poses);
    std::vector<std::uint8_t> pixels(std::size_t(grid.width()) * std::size_t(grid.height()));
    grid.read(GL_RED, GL_UNSIGNED_BYTE, pixels.data(), pixels.size());
    return std::pair(pixels, simulator.similarity(poses));
  };
  for (const int patch : {0, 12}) {
    const auto [expected_pixels, expected_similarities] = drawn({8, 1}, patch);
    CHECK(*std::max_element(expected_pixels.begin(), expected_pixels.end()) > 60);
    for (const Shared shared : {Shared{4, 1}, {32, 3}, {64, 20}, {8, 64}}) {
      CAPTURE(shared.group, shared.images_per_invocation, patch);
      const auto [pixels, similarities] = drawn(shared, patch);
      CHECK(pixels == expected_pixels);
      for (std::size_t i = 0; i < similarities.size(); ++i)  // some thousand terms, each rounded by 6e-8
        CHECK(similarities[i] == Approx(expected_similarities[i]).margin(1e-5));
    }
  }
}

TEST_CASE("LC2's sums fit a texture, however large the picture and the groups and however many the patches") {
  const test::TestContext context;
  const auto table_of = [](int width, int height, int patch, std::size_t group) {
    const std::vector<gl::PixelPlace> places(std::size_t(width) * std::size_t(height), gl::PixelPlace(0));
    const Image<float> compared(width, height);
    gl::PixelTable table = gl::compared_pixels(places, {&compared, 1}, patch, group).table;
    CHECK(table.pixels == places.size());
    return table;
  };
  for (const std::size_t group : {8, 32, 128}) {
    CAPTURE(group);
    CHECK(3 * table_of(1600, 1000, 0, group).columns <= 16384);
    const gl::PixelTable patches = table_of(kMaxPatches / 2 * kMinPatch, 2 * kMinPatch, kMinPatch, group);
    CHECK(patches.columns >= std::size_t(kMaxPatches));
    CHECK(3 * patches.columns <= 16384);
  }
}
