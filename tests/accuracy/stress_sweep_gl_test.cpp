// Sweeps random scenes. The lines of a plane are bit-identical to those of its picture (tests/imaging), so this test
// stresses the conversion from planes to voxels.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/imaging/sweep_simulator.h"
#include "tests/accuracy/stress_bounds.h"
#include "tests/accuracy/stress_scene.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/parity.h"

using namespace insonate;
using namespace insonate::test;

namespace {

/// Returns planes that are tilted, moved, at rest, crossing in front of the face, or placed at random.
Sweep random_sweep(const Scene& scene, std::uint32_t seed) {
  Draw draw(hash(seed, 0x53eefu));
  const int planes = draw.whole(2, 6);
  Sweep sweep{scene.probe, scene.depth_mm, {}};
  const int way = draw.whole(0, 4);
  if (way == 0)
    sweep.patient_from_plane = swept_planes(scene.pose, planes, draw.within(0.001, 150), draw.within(0, 60));
  for (int i = 0; way > 0 && i < planes; ++i) {
    Pose moved;
    if (way == 1) moved.translation.z = i * draw.within(1e-6, 100);
    if (way == 3) moved.rotation = glm::dmat3(glm::rotate(glm::dmat4(1), 0.3 * i, glm::dvec3(0.01, 1, 0)));
    if (way == 4) {
      moved.rotation = glm::dmat3(glm::rotate(glm::dmat4(1), 6 * draw.share(), glm::dvec3(1, draw.share(), 0.5)));
      moved.translation = 100.0 * glm::dvec3(draw.share(), draw.share(), draw.share());
    }
    sweep.patient_from_plane.push_back(scene.pose * moved);
  }
  return sweep;
}

/// Returns what is wrong in a volume; "" if nothing is.
std::string out_of_bounds(const Volume<float>& fused, const Volume<std::int16_t>& grey) {
  for (std::size_t i = 0; i < grey.voxels.size(); ++i) {
    const bool inside = grey.voxels[i] >= 0;
    const float u = fused.voxels[i];
    if (grey.voxels[i] < -1 || grey.voxels[i] > 255 || inside == std::isnan(u) ||
        (inside && !(u >= 0 && u <= std::numeric_limits<float>::max())))
      return "voxel " + std::to_string(i) + ": U is " + std::to_string(u) + ", grey " + std::to_string(grey.voxels[i]);
  }
  return "";
}

}  // namespace

TEST_CASE("sweeps of random scenes, each from its seed") {
  const long frames = from_environment("INSONATE_STRESS_FRAMES", 100);
  const long first = from_environment("INSONATE_STRESS_SEED", 1);
  const TestContext context;
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  gl::SweepSimulator simulator;
  long holding_voxels = 0, with_echo = 0;
  for (long seed = first; seed < first + frames; ++seed) {
    INFO("seed " << seed);
    const Scene scene =
        compiled_as(random_scene_at_body(std::uint32_t(seed / 10 * 10)), random_scene_at_body(std::uint32_t(seed)));
    const Sweep sweep = random_sweep(scene, std::uint32_t(seed));
    Draw draw(hash(std::uint32_t(seed), 0x961du));
    Grid grid = sweep_grid(sweep, draw.within(5, 50));
    grid.size = glm::min(grid.size, glm::ivec3(24));
    simulator.set_volume(scene.volume, table);
    simulator.set_settings(exact_as_needed(scene.settings));
    simulator.set_sweep(sweep);
    simulator.set_grid(grid);
    const Volume<std::int16_t> grey = simulator.read_grey();
    CHECK(out_of_bounds(simulator.read_fused(), grey) == "");
    holding_voxels += std::ranges::any_of(grey.voxels, [](int level) { return level >= 0; });
    with_echo += std::ranges::any_of(grey.voxels, [](int level) { return level > 0; });
  }
  CHECK(with_echo > frames / 10);
  CHECK(holding_voxels > frames / 5);  // planes that rest or lie close together have no voxels between them
}
