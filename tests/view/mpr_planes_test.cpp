#include "sim/view/mpr_planes.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

using namespace insonate;
using view::kMprPlanes;
using view::MprPlane;
using view::MprPlanes;

namespace {

/// A volume that lies askew in the patient, of 40 x 60 x 20 mm.
Grid askew() {
  Grid grid;
  grid.size = {81, 121, 41};
  grid.spacing = glm::dvec3(0.5);
  grid.direction = glm::dmat3(glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1, -2, 0.4))));
  grid.origin = {30, -20, 110};
  return grid;
}

bool near(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::distance(a, b) < 1e-9;
}

}  // namespace

TEST_CASE("the planes of a swept volume begin in its middle, upright as the probe's picture is") {
  const Grid grid = askew();
  const MprPlanes planes(grid);
  CHECK(near(planes.centre(), grid.centre()));
  CHECK(planes.turned_deg() == Approx(0).margin(1e-9));
  const Pose imaging = planes.frame(MprPlane::imaging, false);
  CHECK(near(imaging.rotation[0], grid.direction[0]));
  CHECK(near(imaging.rotation[1], grid.direction[1]));
  CHECK(near(planes.frame(MprPlane::imaging, true).rotation[0], -grid.direction[0]));
  CHECK(near(planes.frame(MprPlane::side, false).rotation[0], grid.direction[2]));
  CHECK(near(planes.frame(MprPlane::side, true).rotation[1], grid.direction[1]));
  CHECK(near(planes.frame(MprPlane::face, false).rotation[1], grid.direction[2]));
}

TEST_CASE("the planes' frames stay right-handed, perpendicular and upright however they are turned") {
  MprPlanes planes(askew());
  for (int n = 0; n < 500; ++n) planes.turn(kMprPlanes[std::size_t(n) % 3], 7.3 + n % 11, n % 2 == 0);
  for (const MprPlane plane : kMprPlanes) {
    const glm::dmat3 axes = planes.frame(plane, true).rotation;
    CHECK(orthonormal_error(axes) < 1e-9);
    CHECK(glm::dot(glm::cross(axes[0], axes[1]), axes[2]) == Approx(1));
    CHECK(std::abs(glm::dot(axes[2], planes.normal(plane))) == Approx(1));
    for (const MprPlane other : kMprPlanes)
      if (other != plane) CHECK(glm::dot(planes.normal(plane), planes.normal(other)) == Approx(0).margin(1e-9));
  }
}

TEST_CASE("turning in one plane's picture turns the two others clockwise and leaves it") {
  for (const bool marker_left : {false, true}) {
    MprPlanes planes(askew());
    const Pose before = planes.frame(MprPlane::imaging, marker_left);
    const glm::dvec3 side = planes.normal(MprPlane::side);
    planes.turn(MprPlane::imaging, 30, marker_left);
    CHECK(near(planes.frame(MprPlane::imaging, marker_left).rotation[0], before.rotation[0]));
    // In the picture, whose y points down, from (1, 0) clockwise is towards (0, 1).
    const glm::dvec2 was(glm::dot(side, before.rotation[0]), glm::dot(side, before.rotation[1]));
    const glm::dvec3 turned = planes.normal(MprPlane::side);
    const glm::dvec2 is(glm::dot(turned, before.rotation[0]), glm::dot(turned, before.rotation[1]));
    CHECK(was.x * is.y - was.y * is.x == Approx(0.5));
    CHECK(planes.turned_deg() == Approx(30));
    planes.reset();
    CHECK(planes.turned_deg() == Approx(0).margin(1e-9));
  }
}

TEST_CASE("the planes' point stays within the volume") {
  const Grid grid = askew();
  MprPlanes planes(grid);
  planes.shift(MprPlane::imaging, 4);
  CHECK(near(planes.centre(), grid.centre() + 4.0 * grid.direction[2]));
  planes.shift(MprPlane::imaging, 400);
  CHECK(near(planes.centre(), grid.centre() + 10.0 * grid.direction[2]));
}
