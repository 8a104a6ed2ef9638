// However numbers are kept on the device, the picture is that of the default and of the reference, within what the way
// they are kept can be off by.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "sim/gl/simulator.h"
#include "sim/reference/reference.h"
#include "tests/gl/parity.h"
#include "tests/gl/test_body.h"
#include "tests/gl/test_context.h"

using namespace insonate;

namespace {

constexpr gl::Representation kStoredGradient = {gl::VolumeFormat::normalized_16, false, true};

struct Fixture {
  test::TestContext context;
  AcousticVolume body = test::test_body();
  TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  Probe probe = *find_probe("curvilinear");
  Pose pose = test::on_the_skin(0, 9, 12);  // over a rib, a cyst and gas
  double depth_mm = 120;
  Settings settings = trainer_settings(3.5, depth_mm);

  Fixture() {
    probe.lines = 64;
    settings.samples = 300;
    settings.image_width = 200;
    settings.image_height = 160;
    settings.skipping = false;  // which the reference does not do
    settings = test::exact_as_needed(settings);
  }

  Stages<float> drawn(const gl::Representation& representation) const {
    gl::Simulator simulator({}, gl::Scheme::of_device(), representation);
    simulator.set_volume(body, table);
    simulator.set_probe(probe, depth_mm);
    simulator.set_settings(settings);
    simulator.set_pose(pose);
    return simulator.read_stages();
  }

  Stages<double> reference() const {
    return simulate_reference(trilinear_field(body), table, probe, depth_mm, settings, pose);
  }
};

/// Between two pictures, over the fan.
struct Difference {
  double rms_grey = 0, above_1 = 0;  ///< grey levels; share of the pixels that differ by more than one
  int worst = 0;                     ///< grey levels
};

template <typename Real>
Difference between(const Stages<Real>& expected, const Stages<float>& got) {
  REQUIRE(expected.inside.pixels == got.inside.pixels);
  Difference difference;
  double inside = 0, squares = 0, above = 0;
  for (std::size_t i = 0; i < got.grey.pixels.size(); ++i) {
    if (!got.inside.pixels[i]) continue;
    const int error = std::abs(int(expected.grey.pixels[i]) - int(got.grey.pixels[i]));
    difference.worst = std::max(difference.worst, error);
    above += error > 1;
    squares += double(error) * error;
    ++inside;
  }
  REQUIRE(inside > 10000);
  REQUIRE(*std::max_element(got.grey.pixels.begin(), got.grey.pixels.end()) > 100);
  difference.rms_grey = std::sqrt(squares / inside);
  difference.above_1 = above / inside;
  std::printf("  RMS %.3f grey levels, %.3f %% above 1, worst %d\n", difference.rms_grey, 100 * difference.above_1,
              difference.worst);
  return difference;
}

}  // namespace

TEST_CASE("a volume of 32-bit floats draws the picture of the default, and as exactly as it") {
  const Fixture f;
  const Stages<float> got = f.drawn({gl::VolumeFormat::float_32});
  // Whole numbers over 32767, in single precision either way: what half floats make of them, 0.04, would show.
  const Difference from_default = between(f.drawn({}), got);
  CHECK(from_default.rms_grey < 0.01);
  CHECK(from_default.worst <= 1);
  const Difference from_reference = between(f.reference(), got);  // as the default, tests/gl/parity_gl_test.cpp
  CHECK(from_reference.above_1 <= 0.001);
  CHECK(from_reference.worst <= 2);
}

TEST_CASE("a volume of half floats draws the picture within what their rounding does to densities") {
  const Fixture f;
  const Stages<float> got = f.drawn({gl::VolumeFormat::float_16});
  for (const Difference& d : {between(f.drawn({}), got), between(f.reference(), got)}) {
    CHECK(d.rms_grey > 0);
    CHECK(d.rms_grey < 1);
  }
}

TEST_CASE("half floats from stage to stage draw the picture within what their rounding does to a level") {
  Fixture f;
  // A half float is off by 2^-11 of itself at most, what is kept as its fourth root by four times that. T, the square
  // of such an I, is off by 12 of them, S, twice kept and of what was kept, by 3, X by 4: 0.04 dB in all, a fifth of a
  // grey level, on whichever side of a step.
  for (const bool loud : {false, true}) {
    if (loud) f.settings.gain_db = 30, f.settings.face_reflection = 1;
    const Stages<float> got = f.drawn({gl::VolumeFormat::normalized_16, true});
    for (const Difference& d : {between(f.drawn({}), got), between(f.reference(), got)}) {
      CHECK(d.rms_grey > 0);
      CHECK(d.worst <= 2);
      CHECK(d.above_1 <= 0.001);
    }
  }
}

TEST_CASE("where density rises evenly, a stored gradient says what differences say, whichever way the voxels lie") {
  Fixture f;
  const Grid& grid = f.body.grid;
  for (int k = 0; k < grid.size.z; ++k)
    for (int j = 0; j < grid.size.y; ++j)
      for (int i = 0; i < grid.size.x; ++i)
        f.body.voxels[grid.offset({i, j, k})].hu = std::int16_t(3 * i - 2 * j + 5 * k - 185);
  f.depth_mm = 50;  // so far the fan lies within the grid, around which density falls at once
  f.pose.translation.y = 20;
  f.settings.gel_mm = 0;
  const Difference from_reference = between(f.reference(), f.drawn(kStoredGradient));  // as the default
  CHECK(from_reference.above_1 <= 0.001);
  CHECK(from_reference.worst <= 2);
}

TEST_CASE("a stored gradient draws the same patient, but for how soft its edges are") {
  // The gradient comes from voxels two apart, so that an edge is met in the cells on both its sides too, half as steep.
  // Echoes of few pixels tilt otherwise; shadows beside gas, bone and skin, which cells of 1.3 to 2.1 mm part, are
  // wider by as much: nearer to the picture with shadows than to the one without, not by far.
  Fixture f;
  const Stages<float> expected = f.drawn({}), got = f.drawn(kStoredGradient);
  const Difference from_default = between(expected, got), from_reference = between(f.reference(), got);
  f.settings.edge_shadow = false;
  const Stages<float> expected_bare = f.drawn({}), got_bare = f.drawn(kStoredGradient);
  const Difference shadows = between(expected_bare, expected);
  for (const Difference& d : {from_default, from_reference}) {
    CHECK(d.rms_grey > 1);
    CHECK(d.rms_grey < shadows.rms_grey);
  }
  for (const Difference& d : {between(expected_bare, got_bare), between(f.reference(), got_bare)}) {
    CHECK(d.rms_grey > 0);
    CHECK(d.rms_grey < 2);
  }
}
