#include "sim/reconstruction/growing_volume.h"

#include <catch2/catch.hpp>

#include "sim/reconstruction/sweep_extent.h"
#include "tests/reconstruction/swept_scene.h"

using namespace insonate;

namespace {

const Scene kWaves = [](const glm::dvec3& at) { return 120 + 80 * std::sin(0.4 * at.x) * std::cos(0.5 * at.z); };

ReconstructedVolume grown(const std::vector<TrackedPicture>& pictures, double voxel_mm, std::size_t most_voxels,
                          std::string* remark = nullptr) {
  GrowingVolume volume(voxel_mm, {}, most_voxels);
  for (const TrackedPicture& picture : pictures) volume.add(picture);
  ReconstructedVolume finished = volume.finish();
  if (remark) *remark = volume.remark();
  return finished;
}

/// The largest difference of two volumes that share voxels, at the voxels of the first.
int worst_difference(const ReconstructedVolume& first, const ReconstructedVolume& second) {
  int worst = 0;
  for (int k = 0; k < first.grey.grid.size.z; ++k)
    for (int j = 0; j < first.grey.grid.size.y; ++j)
      for (int i = 0; i < first.grey.grid.size.x; ++i) {
        const glm::dvec3 index =
            second.grey.grid.index_from_patient(first.grey.grid.patient_from_index(glm::dvec3(i, j, k)));
        const glm::ivec3 voxel(glm::round(index));
        REQUIRE(glm::distance(index, glm::dvec3(voxel)) < 1e-6);
        const bool held = second.grey.grid.contains(voxel);
        const int known = held ? second.known.at(voxel) : 0, grey = held ? second.grey.at(voxel) : 0;
        worst = std::max(
            {worst, std::abs(first.known.at({i, j, k}) - known) * 1000, std::abs(first.grey.at({i, j, k}) - grey)});
      }
  return worst;
}

}  // namespace

TEST_CASE("a volume that grows with the sweep has the voxels of one whose grid was large from the start") {
  for (const double step_mm : {0.5, -0.5}) {
    const HandSweep sweep{.step_mm = step_mm};
    const auto pictures = sweep.pictures_of(kWaves);
    const ReconstructedVolume volume = grown(pictures, 0.7, kMaxReconstructedVoxels);
    Reconstruction whole(volume.grey.grid);
    whole.extend({3, 3, 3}, {3, 3, 3});
    for (const TrackedPicture& picture : pictures) whole.add(picture);
    CHECK(worst_difference(whole.filled(), volume) == 0);
    CHECK(volume.grey.grid.spacing == glm::dvec3(0.7));
  }
}

TEST_CASE("a volume that grows too large gets larger voxels, and a sentence") {
  const auto pictures = HandSweep().pictures_of(kWaves);
  std::string remark;
  const ReconstructedVolume volume = grown(pictures, 0.5, 200000, &remark);
  CHECK(volume.grey.grid.count() <= 200000);
  CHECK(volume.grey.grid.spacing.x > 0.5);
  CHECK(remark.find("0.50 mm") != std::string::npos);
  CHECK(grown(pictures, 2, 200000, &remark).grey.grid.spacing.x == 2);
  CHECK(remark.empty());
}

TEST_CASE("a grid that lies askew of the whole sweep is replaced at its end") {
  const HandSweep sweep;
  const auto region = rectangle_region(sweep.width, sweep.height, {0, 0, sweep.width, sweep.height});
  std::vector<TrackedPicture> pictures;
  for (int n = 0; n <= 40; ++n) {
    const glm::dmat4 tilt = glm::rotate(glm::dmat4(1.0), glm::radians(double(n)), glm::dvec3(1, 0, 0));
    pictures.push_back(picture_of(kWaves, oblique_pose() * Pose{glm::dmat3(tilt), {}}, sweep.geometry(), region, n));
  }
  const Grid grid = grown(pictures, 0.7, kMaxReconstructedVoxels).grey.grid;
  CHECK(grid == choose_grid(pictures, 0.7).grid);
  CHECK(angle_between_deg({grid.direction, {}}, oblique_pose()) == Approx(20));
}

TEST_CASE("a volume of no pictures is a mistake of the program") {
  GrowingVolume volume(1, {}, 1000);
  CHECK_THROWS_AS(volume.finish(), std::logic_error);
}
