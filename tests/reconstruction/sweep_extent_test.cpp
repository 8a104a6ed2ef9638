#include "sim/reconstruction/sweep_extent.h"

#include <catch2/catch.hpp>

#include "tests/reconstruction/swept_scene.h"

using namespace insonate;

namespace {

std::vector<TrackedPicture> black(const HandSweep& sweep) {
  return sweep.pictures_of([](const glm::dvec3&) { return 0; });
}

}  // namespace

TEST_CASE("a grid lies along the mean plane and holds all pictures, with little more") {
  const HandSweep sweep{.tremor_deg = 4};
  const auto pictures = black(sweep);
  const GridChoice choice = choose_grid(pictures, 0.5);
  CHECK(choice.remark.empty());
  CHECK(choice.grid.spacing == glm::dvec3(0.5));
  CHECK(angle_between_deg({choice.grid.direction, {}}, oblique_pose()) < 1);
  CHECK_FALSE(why_not_rigid(Pose{choice.grid.direction, choice.grid.origin}.matrix()));
  glm::dvec3 low(1e9), high(-1e9);
  for (const TrackedPicture& picture : pictures)
    for (const glm::dvec2 pixel : {glm::dvec2(0, 0), {95, 0}, {0, 79}, {95, 79}}) {
      const glm::dvec3 index =
          choice.grid.index_from_patient(glm::dvec3(picture.patient_from_pixel * glm::dvec4(pixel, 0, 1)));
      low = glm::min(low, index);
      high = glm::max(high, index);
    }
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(low[axis] >= 1 - 1e-9);
    CHECK(low[axis] < 2);
    CHECK(high[axis] <= choice.grid.size[axis] - 2 + 1e-9);
    CHECK(high[axis] > choice.grid.size[axis] - 3);
  }
}

TEST_CASE("voxels are enlarged until they fit, and a sentence gives both sizes") {
  const auto pictures = black(HandSweep());
  const GridChoice choice = choose_grid(pictures, 0.1, 100000);
  CHECK(choice.grid.count() <= 100000);
  CHECK(choice.grid.count() > 50000);
  CHECK(choice.grid.spacing.x > 0.5);
  CHECK(choice.remark.find("0.10 mm") != std::string::npos);

  auto far = pictures;
  far.back().patient_from_pixel[3] += glm::dvec4(9e4, 0, 0, 0);  // a tracker's stray pose
  CHECK(choose_grid(far, 0.5).grid.count() <= kMaxReconstructedVoxels);
  const glm::ivec3 size = choose_grid(far, 0.5).grid.size;
  CHECK(std::max({size.x, size.y, size.z}) <= kMaxReconstructedSide);
}

TEST_CASE("pictures that turn by half a circle have a grid too") {
  std::vector<TrackedPicture> pictures;
  const HandSweep sweep;
  const auto region = rectangle_region(96, 80, {0, 0, 96, 80});
  for (int n = 0; n <= 36; ++n) {
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), glm::radians(10.0 * n), glm::dvec3(0, 1, 0));
    TrackedPicture picture;
    picture.grey = Image<std::uint8_t>(96, 80);
    picture.region = region;
    picture.patient_from_pixel = patient_from_pixel(oblique_pose() * Pose{glm::dmat3(turn), {}}, sweep.geometry());
    pictures.push_back(picture);
  }
  const Grid grid = choose_grid(pictures, 1).grid;
  CHECK_FALSE(why_not_rigid(Pose{grid.direction, grid.origin}.matrix()));
  CHECK(grid.size.x < 60);
  CHECK(grid.size.y < 60);
}

TEST_CASE("a fan's outline encloses it") {
  for (const Probe& probe : probes()) {
    const ImageGeometry geometry = image_geometry(probe, 80, 160, 120);
    const auto region = fan_region(probe, 80, geometry);
    glm::dvec2 low(1e9), high(-1e9);
    for (const glm::dvec2& pixel : region->outline) {
      low = glm::min(low, pixel);
      high = glm::max(high, pixel);
    }
    std::size_t inside = 0;
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 160; ++x) {
        if (!region->inside.at(x, y)) continue;
        ++inside;
        CHECK((x >= low.x - 1 && x <= high.x + 1 && y >= low.y && y <= high.y));
        CHECK((x >= region->spans[std::size_t(y)].begin && x < region->spans[std::size_t(y)].end));
      }
    CHECK(inside > 4000);
    CHECK(inside < 160 * 120);
  }
}
