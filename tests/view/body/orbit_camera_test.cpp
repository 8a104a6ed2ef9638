#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "sim/view/body/line_of_sight.h"

using insonate::Pose;
using insonate::view::OrbitCamera;
using insonate::view::Side;

namespace {

constexpr int kWidth = 640, kHeight = 480;

glm::dvec2 place(const OrbitCamera& camera, const glm::dvec3& p) {
  return camera.project(p, kWidth, kHeight);
}

}  // namespace

TEST_CASE("from the front the patient's left is on the right and the head is up") {
  const OrbitCamera camera;
  CHECK(place(camera, {50, 0, 0}).x > kWidth / 2.0);
  CHECK(place(camera, {0, 0, 50}).y < kHeight / 2.0);
  CHECK(place(camera, {0, 0, 0}) == glm::dvec2(kWidth, kHeight) / 2.0);
}

TEST_CASE("yaw and pitch take the camera where they say") {
  OrbitCamera camera;
  camera.distance_mm = 700;
  camera.yaw_deg = 90;
  CHECK(glm::distance(camera.patient_from_camera().translation, glm::dvec3(700, 0, 0)) < 1e-9);
  camera.yaw_deg = 180;
  CHECK(glm::distance(camera.patient_from_camera().translation, glm::dvec3(0, 700, 0)) < 1e-9);
  CHECK(place(camera, {50, 0, 0}).x < kWidth / 2.0);
  camera.pitch_deg = 60;
  CHECK(camera.patient_from_camera().translation.z == Approx(700 * std::sqrt(3.0) / 2));
  const glm::dmat3 r = camera.patient_from_camera().rotation;
  CHECK(glm::determinant(r) == Approx(1));
}

TEST_CASE("perspective: a length at the centre has the pixels that the field of view gives it") {
  OrbitCamera camera;
  camera.distance_mm = 500;
  camera.field_of_view_deg = 90;  // the picture's height spans twice the distance
  CHECK(place(camera, {100, 0, 0}).x - kWidth / 2.0 == Approx(100 * kHeight / 1000.0));
}

TEST_CASE("the line of sight through a pixel meets what is seen there") {
  OrbitCamera camera;
  camera.yaw_deg = 35;
  camera.pitch_deg = -20;
  camera.centre = {10, -5, 40};
  for (const glm::dvec3& point : {glm::dvec3(80, -60, 20), glm::dvec3(-120, 90, 130)}) {
    const auto line = insonate::view::line_of_sight(camera, place(camera, point), kWidth, kHeight);
    CHECK(line.eye == camera.patient_from_camera().translation);
    CHECK(glm::distance(line.direction, glm::normalize(point - line.eye)) < 1e-9);
  }
}

TEST_CASE("panning moves what lies at the centre's depth by the pointer's pixels") {
  OrbitCamera camera;
  camera.yaw_deg = 35;
  camera.pitch_deg = -20;
  const glm::dvec3 held = camera.centre;
  camera.pan({30, -12}, kHeight);
  const glm::dvec2 moved = place(camera, held) - glm::dvec2(kWidth, kHeight) / 2.0;
  CHECK(moved.x == Approx(30));
  CHECK(moved.y == Approx(-12));
}

TEST_CASE("from each side the camera sees the whole volume, and the patient lies as that side is named") {
  insonate::Grid grid;
  grid.size = {200, 140, 180};
  grid.spacing = {2, 2, 2};
  grid.origin = {-200, -140, -180};
  const glm::dvec3 centre = grid.centre();
  struct Seen {
    Side side;
    glm::dvec3 nearer, right, up;  // directions in the patient
  };
  const glm::dvec3 left(1, 0, 0), posterior(0, 1, 0), head(0, 0, 1);
  for (const Seen& seen : {Seen{Side::front, -posterior, left, head}, Seen{Side::back, posterior, -left, head},
                           Seen{Side::right, -left, -posterior, head}, Seen{Side::left, left, posterior, head},
                           Seen{Side::head, head, left, posterior}, Seen{Side::feet, -head, left, -posterior}}) {
    CAPTURE(int(seen.side));
    const OrbitCamera camera = OrbitCamera::from(seen.side, grid);
    const glm::dvec3 eye = camera.patient_from_camera().translation - centre;
    CHECK(glm::dot(glm::normalize(eye), seen.nearer) > 0.999);
    CHECK(place(camera, centre) == glm::dvec2(kWidth, kHeight) / 2.0);
    CHECK(place(camera, centre + 50.0 * seen.right).x > kWidth / 2.0 + 20);
    CHECK(place(camera, centre + 50.0 * seen.up).y < kHeight / 2.0 - 20);
    for (const double x : {-200.0, 200.0})
      CHECK(std::abs(place(camera, centre + x * left).y - kHeight / 2.0) < kHeight / 2.0);
  }
}

TEST_CASE("a camera that faces a plane looks across it from the front, whatever the plane") {
  insonate::Grid grid;
  grid.size = {300, 200, 400};
  for (const glm::dvec3& normal : {glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1), glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0),
                                   glm::dvec3(0, 1, 0), glm::dvec3(0.6, 0.48, 0.64)}) {
    const glm::dvec3 x = glm::normalize(glm::cross(normal, glm::dvec3(0.3, 0.5, -0.8)));
    const Pose probe{glm::dmat3(x, glm::cross(normal, x), normal), glm::dvec3(10, -60, 20)};
    const OrbitCamera camera = OrbitCamera::facing(grid, probe);
    const glm::dvec3 to_camera = -camera.patient_from_camera().rotation[2];
    INFO("normal " << normal.x << " " << normal.y << " " << normal.z);
    CHECK(std::abs(glm::dot(to_camera, normal)) > 0.8);
    CHECK(glm::dot(to_camera, glm::dvec3(0, -1, 0)) > 0);
    const glm::dvec2 face = camera.project(probe.translation, kWidth, kHeight);
    CHECK((face.x > 0 && face.x < kWidth && face.y > 0 && face.y < kHeight));
  }
}

TEST_CASE("a camera that faces a plane has body, probe and picture in its picture, and fills it, wide or high") {
  insonate::Grid grid;
  grid.size = {340, 240, 400};
  const Pose probe{glm::dmat3(1.0), grid.centre() - glm::dvec3(0, 100, 0)};
  for (const auto& [width, height] : {std::pair{570, 265}, {400, 400}, {300, 700}}) {
    const OrbitCamera camera = OrbitCamera::facing(grid, probe, double(width) / height);
    double reach = 0;
    for (const glm::dvec3& point : {grid.centre() + glm::dvec3(120, 0, 0), grid.centre() - glm::dvec3(120, 0, 0),
                                    grid.centre() + glm::dvec3(0, 0, 150), grid.centre() - glm::dvec3(0, 0, 150),
                                    probe.point({0, -150, 0}), probe.point({0, 180, 0})}) {
      const glm::dvec2 seen = camera.project(point, width, height) / glm::dvec2(width, height);
      CAPTURE(width, height, seen.x, seen.y);
      CHECK((seen.x > 0.02 && seen.x < 0.98 && seen.y > 0.02 && seen.y < 0.98));
      reach = std::max({reach, std::abs(seen.x - 0.5), std::abs(seen.y - 0.5)});
    }
    CHECK(reach > 0.3);
  }
}

TEST_CASE("dragging never turns the camera over and never loses the patient") {
  OrbitCamera camera;
  camera.orbit(350, 400);
  CHECK(camera.pitch_deg < 90);
  CHECK(std::abs(camera.yaw_deg) <= 180);
  camera.zoom(1e9);
  CHECK(camera.distance_mm > 1);
  camera.zoom(1e-12);
  CHECK(camera.distance_mm < 1e5);
}
