// Compares a sweep on the graphics card with the reference in double precision. The tolerances are those of the model's
// accuracy contract.

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sim/core/hash.h"
#include "sim/reference/sweep_reference.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/parity.h"
#include "tests/imaging/test_sweeps.h"

using namespace insonate;
using test::by_hand;
using test::everything;
using test::of_the_paper;
using test::simulator_of;
using test::swept;
using test::tissues;

namespace {

Image<double> row_of(const std::vector<double>& values) {
  Image<double> row(int(values.size()), 1);
  row.pixels = values;
  return row;
}

void check_against_reference(const Sweep& sweep, Settings settings) {
  const test::TestContext context;
  settings = test::exact_as_needed(settings);
  settings.skipping = false;  // which the reference does not implement
  const Grid grid = sweep_grid(sweep, 4);
  gl::SweepSimulator simulator = simulator_of(sweep, settings, grid);
  const Volume<float> fused = simulator.read_fused();
  const Volume<std::int16_t> grey = simulator.read_grey();

  const AcousticVolume body = test::test_body();
  const MediumField field = trilinear_field(body);
  const auto reference = [&](const MediumField& of_body, const Grid& of_voxels) {
    return simulate_sweep_reference(of_body, tissues(), sweep, settings, of_voxels);
  };
  const ReferenceVolume expected = reference(field, grid);
  // Mesa's arctangent is within 1e-6 rad, which is 2e-4 mm at a fan's end, 170 mm from its apex. The voxels'
  // coordinates are more accurate than that. The error shows where an echo lies beside one of another magnitude.
  std::array<ReferenceVolume, 4> uncertain;
  for (std::uint32_t i = 0; i < uncertain.size(); ++i) {
    Grid moved = grid;
    for (int axis = 0; axis < 3; ++axis)
      moved.origin[axis] += 2e-4 * (2.0 * unit_float(hash(i, std::uint32_t(axis))) - 1.0);
    uncertain[i] = reference(test::as_single_precision_knows_it(field, i), moved);
  }

  // At the edge of the sweep rounding alone decides what is inside.
  long at_edge = 0;
  std::vector<double> expected_fused;
  std::array<std::vector<double>, 4> uncertain_fused;
  std::vector<float> got_fused;
  std::vector<int> expected_grey, got_grey;
  for (std::size_t i = 0; i < grid.count(); ++i) {
    REQUIRE(std::isnan(fused.voxels[i]) == (grey.voxels[i] < 0));
    REQUIRE(std::isnan(expected.fused.voxels[i]) == (expected.grey.voxels[i] < 0));
    const bool inside = grey.voxels[i] >= 0;
    if (inside != expected.grey.voxels[i] >= 0) ++at_edge;
    const auto outside_there = [&](const ReferenceVolume& volume) { return volume.grey.voxels[i] < 0; };
    if (!inside || outside_there(expected) || std::ranges::any_of(uncertain, outside_there)) continue;
    expected_fused.push_back(expected.fused.voxels[i]);
    for (std::size_t j = 0; j < uncertain.size(); ++j) uncertain_fused[j].push_back(uncertain[j].fused.voxels[i]);
    got_fused.push_back(fused.voxels[i]);
    expected_grey.push_back(expected.grey.voxels[i]);
    got_grey.push_back(grey.voxels[i]);
  }
  CHECK(at_edge <= 5);
  REQUIRE(got_fused.size() > grid.count() / 10);
  Image<float> got(int(got_fused.size()), 1);
  got.pixels = got_fused;
  test::check_fused(
      row_of(expected_fused),
      {row_of(uncertain_fused[0]), row_of(uncertain_fused[1]), row_of(uncertain_fused[2]), row_of(uncertain_fused[3])},
      got, settings.dynamic_range_db, settings.waves ? 2e-3 : 0);
  if (settings.waves)
    test::check_grey_of_waves(expected_grey, got_grey);
  else
    test::check_grey(expected_grey, got_grey);
}

}  // namespace

TEST_CASE("GLSL agrees with the reference: a 3D probe, every effect on") {
  Settings settings = everything();
  settings.waves = GENERATE(false, true);
  check_against_reference(swept("curvilinear"), settings);
}

TEST_CASE("GLSL agrees with the reference: a 3D probe that rings, and clutter of the body wall alone") {
  Settings settings = everything();
  settings.ring_down = kUsualRingDown;
  settings.waves = true;
  settings.electronic_noise = false;
  settings.clutter_db = -100;
  settings.gain_db = 30;
  check_against_reference(swept("curvilinear"), settings);
}

TEST_CASE("GLSL agrees with the reference: a 3D probe in the paper's own mode, its brightest voxel white") {
  check_against_reference(swept("phased"), of_the_paper());
}

TEST_CASE("GLSL agrees with the reference: planes that a hand has swept") {
  Settings settings = everything();
  settings.slice_planes = 1;
  settings.grey_map = GreyMap::s_curve;
  check_against_reference(by_hand(), settings);
}
