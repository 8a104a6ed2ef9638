// The contrast of cysts in the picture: what lies inside scatters as many decibels less or more as its echogenicity
// says, whatever the speckle.

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <cmath>
#include <utility>
#include <vector>

#include "sim/imaging/simulator.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/test_sweeps.h"

using namespace insonate;

namespace {

constexpr double kDepth_mm = 80, kRadius_mm = 7;

/// Cylinders along the elevation, side by side across the picture, in tissue of 0 dB without interfaces.
struct Cyst {
  double x_mm, echogenicity_db;
};
const std::vector<Cyst> kCysts = {{-33, -60}, {-11, -6}, {11, 3}, {33, 6}};

AcousticVolume phantom() {
  AcousticVolume volume;
  volume.grid.size = {240, 240, 40};
  volume.grid.spacing = glm::dvec3(0.5);
  volume.grid.origin = {-60, -5, -10};
  for (int k = 0; k < volume.grid.size.z; ++k)
    for (int j = 0; j < volume.grid.size.y; ++j)
      for (int i = 0; i < volume.grid.size.x; ++i) {
        const glm::dvec3 at = volume.grid.patient_from_index({i, j, k});
        double echogenicity_db = 0;
        for (const Cyst& cyst : kCysts)
          if (glm::distance(glm::dvec2(at), {cyst.x_mm, kDepth_mm}) < kRadius_mm)
            echogenicity_db = cyst.echogenicity_db;
        volume.voxels.push_back({60, std::int16_t(std::lround(100 * echogenicity_db))});
      }
  return volume;
}

}  // namespace

TEST_CASE("the contrast of cysts is that of their echogenicity") {
  test::TestContext context;
  gl::Simulator simulator;
  simulator.set_volume(phantom(), test::tissues());
  const auto [name, patterns] = GENERATE(std::pair("curvilinear", 12), std::pair("linear", 12));
  CAPTURE(name);
  Probe probe = *find_probe(name);
  probe.width_mm = 100;  // all four lie under it
  const double depth_mm = 110;
  simulator.set_probe(probe, depth_mm);
  Settings settings = trainer_settings(3.5, depth_mm);
  settings.focus_mm = kDepth_mm;
  settings.absorption = settings.clutter = settings.electronic_noise = false;

  const ImageGeometry picture = image_geometry(probe, depth_mm, settings.image_width, settings.image_height);
  // At most two thirds of the radius, which leaves the beam and the pulse within the cyst. Around it, the ring from one
  // and a third to one and two thirds of the radius, which no other cyst reaches.
  std::vector<double> inside(kCysts.size()), around(inside);
  std::vector<long> pixels_inside(kCysts.size()), pixels_around(pixels_inside);
  for (int pattern = 1; pattern <= patterns; ++pattern) {
    settings.speckle_seed = std::uint32_t(pattern);
    simulator.set_settings(settings);
    simulator.set_pose(Pose());
    const Image<float> fused = simulator.read_stages().fused;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x)
        for (std::size_t c = 0; c < kCysts.size(); ++c) {
          const double away = glm::distance(picture.plane_mm(x, y), {kCysts[c].x_mm, kDepth_mm}) / kRadius_mm;
          if (away < 2.0 / 3) inside[c] += fused.at(x, y), ++pixels_inside[c];
          if (away > 4.0 / 3 && away < 5.0 / 3) around[c] += fused.at(x, y), ++pixels_around[c];
        }
  }
  for (std::size_t c = 0; c < kCysts.size(); ++c) {
    const double contrast_db =
        10 * std::log10(inside[c] / double(pixels_inside[c]) / (around[c] / double(pixels_around[c])));
    CAPTURE(kCysts[c].echogenicity_db, contrast_db);
    if (kCysts[c].echogenicity_db > -60)
      CHECK(std::abs(contrast_db - kCysts[c].echogenicity_db) < 1);
    else
      CHECK(contrast_db < -40);  // nothing but what beam and pulse bring in from beside it
  }
}
