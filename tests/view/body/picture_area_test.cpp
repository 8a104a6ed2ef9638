#include "sim/view/body/picture_area.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>

using namespace insonate;
using namespace insonate::view;

namespace {

constexpr int kAcross_px = 320, kDown_px = 200;

// A box of 100 x 60 x 40 mm around a point.
glm::dmat4 box_from_patient() {
  const glm::dmat4 patient_from_box = glm::scale(glm::translate(glm::dmat4(1.0), {-40, -30, 5}), {100.0, 60.0, 40.0});
  return glm::inverse(patient_from_box);
}

}  // namespace

TEST_CASE("the corners of a box are those that its matrix maps to 0 and 1") {
  const BoxCorners corners = corners_of(box_from_patient());
  CHECK(glm::distance(corners[0], glm::dvec3(-40, -30, 5)) < 1e-9);
  CHECK(glm::distance(corners[5], glm::dvec3(60, -30, 45)) < 1e-9);
  CHECK(glm::distance(corners[7], glm::dvec3(60, 30, 45)) < 1e-9);
}

TEST_CASE("the area of a box holds every pixel in which a point of it appears, and not many more") {
  const BoxCorners box = corners_of(box_from_patient());
  OrbitCamera camera;
  camera.yaw_deg = GENERATE(0.0, 35.0, 160.0);
  camera.pitch_deg = GENERATE(-70.0, 20.0);
  camera.distance_mm = GENERATE(250.0, 1500.0);
  const PictureArea area = area_of(box, camera, kAcross_px, kDown_px);
  glm::dvec2 least(1e9), most(-1e9);
  for (const glm::dvec3& corner : box) {
    const glm::dvec2 at = camera.project(corner, kAcross_px, kDown_px);
    least = glm::min(least, at);
    most = glm::max(most, at);
  }
  CAPTURE(camera.yaw_deg, camera.pitch_deg, camera.distance_mm, least.x, least.y, most.x, most.y);
  const glm::dvec2 size(kAcross_px, kDown_px);
  for (int axis = 0; axis < 2; ++axis) {
    CHECK(area.first[axis] <= std::max(least[axis], 0.0));
    CHECK(area.end[axis] >= std::min(most[axis], size[axis]));
    CHECK(area.first[axis] >= std::max(least[axis] - 3, 0.0));
    CHECK(area.end[axis] <= std::min(most[axis] + 3, size[axis]));
  }
}

TEST_CASE("what lies beside the picture has an empty area, and what reaches behind the camera the whole picture") {
  OrbitCamera camera;  // looks along +y, from 900 mm before the origin
  const auto area = [&](const std::vector<glm::dvec3>& points) {
    return area_of(points, camera, kAcross_px, kDown_px);
  };
  const auto pixels = [&](const PictureArea& a) { return (a.end.x - a.first.x) * (a.end.y - a.first.y); };
  CHECK(pixels(area({})) == 0);
  CHECK(pixels(area({{5000, 0, 0}, {6000, 10, 10}})) == 0);
  CHECK(pixels(area({{0, 0, 0}})) <= 16);
  CHECK(pixels(area({{0, 0, 0}, {0, -2000, 0}})) == kAcross_px * kDown_px);
}

TEST_CASE("a plane cuts a box in a polygon whose corners lie in the plane and on the box") {
  const BoxCorners box = corners_of(box_from_patient());
  const glm::dmat4 to_box = box_from_patient();
  Pose plane;
  plane.translation = {10, 0, 20};
  std::size_t corners = 4;  // across the middle
  SECTION("across the middle") {}
  SECTION("oblique") {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(1.0 / 100, 1.0 / 60, 1.0 / 40));
    const glm::dvec3 across = glm::normalize(glm::cross(normal, {1, 0, 0}));
    plane = {glm::dmat3(across, glm::cross(normal, across), normal), {10, 0, 25}};  // alike to all three axes
    corners = 6;
  }
  SECTION("beside it") {
    plane.translation.z = 50;
    corners = 0;
  }
  const std::vector<glm::dvec3> cut = cut_through(box, plane);
  CHECK(cut.size() == corners);
  for (const glm::dvec3& p : cut) {
    CHECK(std::abs(glm::dot(p - plane.translation, plane.rotation[2])) < 1e-9);
    const glm::dvec3 in_box(to_box * glm::dvec4(p, 1));
    CHECK(glm::all(glm::greaterThan(in_box, glm::dvec3(-1e-9))));
    CHECK(glm::all(glm::lessThan(in_box, glm::dvec3(1 + 1e-9))));
  }
}
