// The structure of tissues in pictures: it shows, and it changes no tissue's brightness.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/imaging/simulator.h"
#include "sim/tissue/acoustic_volume.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/parity.h"

using namespace insonate;

namespace {

constexpr double kDepth_mm = 90;

/// A block of one density, whose skin lies at y = 4 mm.
Volume<std::int16_t> block(int hu) {
  Volume<std::int16_t> ct;
  ct.grid.size = {150, 110, 90};
  ct.voxels.assign(ct.grid.count(), std::int16_t(hu));
  for (int k = 0; k < ct.grid.size.z; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < ct.grid.size.x; ++i) ct.at({i, j, k}) = -1000;
  return ct;
}

struct Grey {
  double mean = 0, of_patches = 0;  ///< of patches of 10 x 10 pixels: the deviation of their means
};

/// Of six planes, in the fan's middle.
Grey grey_of(gl::Simulator& simulator, const AcousticVolume& volume, const TissueTable& table) {
  simulator.set_volume(volume, table);
  double sum = 0, patch_squares = 0, patch_sum = 0;
  int pixels = 0, patches = 0;
  for (const double z : {20, 30, 40, 50, 60, 70}) {
    simulator.set_pose({glm::dmat3(1.0), {75, 9, z}});
    const Image<std::uint8_t> grey = simulator.read_stages().grey;
    for (int top = 120; top + 10 < 360; top += 10)
      for (int left = 240; left + 10 < 400; left += 10) {
        double patch = 0;
        for (int y = top; y < top + 10; ++y)
          for (int x = left; x < left + 10; ++x) patch += grey.at(x, y);
        sum += patch;
        pixels += 100;
        patch_sum += patch / 100;
        patch_squares += patch / 100 * patch / 100;
        ++patches;
      }
  }
  const double mean = patch_sum / patches;
  return {sum / pixels, std::sqrt(patch_squares / patches - mean * mean)};
}

}  // namespace

TEST_CASE("structure shows in pictures, and changes the mean grey of no tissue by three levels") {
  const test::TestContext context;
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  const Probe& probe = *find_probe("curvilinear");
  gl::Simulator simulator;
  simulator.set_probe(probe, kDepth_mm);
  simulator.set_settings(test::exact_as_needed(with_usual_display(trainer_settings(probe.frequency_mhz, kDepth_mm))));
  for (const std::string tissue : {"liver", "spleen", "muscle", "fat", "bowel", "pancreas", ""}) {
    const Volume<std::int16_t> ct = block(tissue == "fat" ? -100 : 55);
    Volume<std::uint8_t> labels;
    if (!tissue.empty()) labels = {ct.grid, std::vector<std::uint8_t>(ct.voxels.size(), 1)};
    const auto grey = [&](bool structure) {
      return grey_of(simulator, make_acoustic_volume(ct, labels, {"", tissue}, table, structure), table);
    };
    const Grey before = grey(false), with = grey(true);
    INFO((tissue.empty() ? "no label" : tissue)
         << ": grey " << before.mean << " becomes " << with.mean << ", deviation of patches " << before.of_patches
         << " becomes " << with.of_patches);
    CHECK(std::abs(with.mean - before.mean) < 3);
    if (tissue == "spleen")
      CHECK(with.of_patches < 1.1 * before.of_patches);
    else
      CHECK(with.of_patches > 1.15 * before.of_patches);
  }
}
