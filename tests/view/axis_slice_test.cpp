#include "sim/view/axis_slice.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "sim/view/edge_letters.h"

using namespace insonate;
using namespace insonate::view;

namespace {

Grid plain_grid() {
  Grid grid;
  grid.size = {101, 81, 201};
  grid.spacing = {2, 2, 3};
  grid.origin = {-100, -80, -300};
  return grid;
}

EdgeLetters letters(SliceAxis axis) {
  const AxisSlice slice = AxisSlice::fitting(axis, plain_grid(), {0, 0, 0}, 300, 200);
  const Pose pose = slice.patient_from_picture();
  return edge_letters(pose.rotation[0], pose.rotation[1]);
}

}  // namespace

TEST_CASE("axis slices follow the radiological convention") {
  CHECK(letters(SliceAxis::axial) == EdgeLetters{"R", "L", "A", "P"});
  CHECK(letters(SliceAxis::coronal) == EdgeLetters{"R", "L", "S", "I"});
  CHECK(letters(SliceAxis::sagittal) == EdgeLetters{"A", "P", "S", "I"});
}

TEST_CASE("the pose of an axis slice is a rotation, and looks from the feet, the front and the patient's left") {
  const glm::dvec3 into[] = {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};
  for (const SliceAxis axis : {SliceAxis::axial, SliceAxis::coronal, SliceAxis::sagittal}) {
    const glm::dmat3 r = AxisSlice::fitting(axis, plain_grid(), {}, 10, 10).patient_from_picture().rotation;
    CHECK(glm::distance(glm::cross(r[0], r[1]), r[2]) < 1e-12);
    CHECK(glm::distance(r[2], into[int(axis)]) < 1e-12);
    CHECK(std::abs(into[int(axis)][normal_axis(axis)]) == 1);
  }
}

TEST_CASE("an axis slice shows the whole volume, in the middle and not stretched") {
  // 202 by 162 by 603 mm with the voxels' halves at the border; the middle is (0, 0, 0).
  const AxisSlice wide = AxisSlice::fitting(SliceAxis::axial, plain_grid(), {0, 0, 12}, 404, 1000);
  CHECK(wide.mm_per_pixel == Approx(0.5));
  CHECK(wide.middle == glm::dvec3(0, 0, 12));
  const AxisSlice high = AxisSlice::fitting(SliceAxis::coronal, plain_grid(), {0, 5, 0}, 1000, 201);
  CHECK(high.mm_per_pixel == Approx(3));
  const glm::dvec2 head_right = high.pixel({-101, 5, 301.5});
  CHECK(head_right.x == Approx(500 - 101 / 3.0));
  CHECK(head_right.y == Approx(0).margin(1e-9));
}

TEST_CASE("places of an axis slice and of the patient map to each other") {
  for (const SliceAxis axis : {SliceAxis::axial, SliceAxis::coronal, SliceAxis::sagittal}) {
    const AxisSlice slice = AxisSlice::fitting(axis, plain_grid(), {20, -30, 40}, 320, 240);
    const glm::dvec3 p = slice.patient_mm({17, 200});
    CHECK(p[normal_axis(axis)] == Approx(glm::dvec3(20, -30, 40)[normal_axis(axis)]));
    CHECK(glm::distance(slice.pixel(p), glm::dvec2(17, 200)) < 1e-9);
  }
}

TEST_CASE("a slice beyond the volume is its outermost one") {
  const AxisSlice above = AxisSlice::fitting(SliceAxis::axial, plain_grid(), {0, 0, 5000}, 100, 100);
  CHECK(above.middle.z == Approx(300));
  const AxisSlice behind = AxisSlice::fitting(SliceAxis::coronal, plain_grid(), {0, 5000, 0}, 100, 100);
  CHECK(behind.middle.y == Approx(80));
}

TEST_CASE("the step between slices is the voxel's extent along the nearest axis of the volume") {
  Grid grid = plain_grid();
  grid.spacing = {1, 2, 3};
  CHECK(slice_step_mm(SliceAxis::axial, grid) == 3);
  CHECK(slice_step_mm(SliceAxis::coronal, grid) == 2);
  CHECK(slice_step_mm(SliceAxis::sagittal, grid) == 1);
  // The volume's k runs to the patient's back, as in a coronal scan.
  grid.direction = glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0));
  CHECK(slice_step_mm(SliceAxis::coronal, grid) == 3);
  CHECK(slice_step_mm(SliceAxis::axial, grid) == 2);
}
