// The volume rendering of swept volumes.

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

#include "sim/view/body/swept_view.h"
#include "tests/view/test_patient.h"

using namespace insonate;
using namespace insonate::view;

namespace {

constexpr int kWidth = 120, kHeight = 90;

/// A bright ball, of which only the half towards the patient's left was seen, in tissue of medium grey.
struct HalfABall {
  Volume<std::uint8_t> grey, known;

  HalfABall() {
    const Grid grid = test::skewed_grid(45);
    grey = {grid, std::vector<std::uint8_t>(grid.count())};
    known = {grid, std::vector<std::uint8_t>(grid.count())};
    for (int k = 0; k < grid.size.z; ++k)
      for (int j = 0; j < grid.size.y; ++j)
        for (int i = 0; i < grid.size.x; ++i) {
          const glm::dvec3 p = grid.patient_from_index({i, j, k});
          grey.at({i, j, k}) = glm::length(p) < 25 ? 200 : 60;
          known.at({i, j, k}) = p.x > 0 ? 2 : 0;
        }
  }
};

OrbitCamera from_the_front() {
  OrbitCamera camera;
  camera.distance_mm = 300;
  return camera;
}

}  // namespace

TEST_CASE("a swept volume shows what is brighter than the threshold, where something was seen") {
  test::Scene::need_context();
  const HalfABall swept;
  SweptView view(swept.grey, swept.known);
  const OrbitCamera camera = from_the_front();
  const auto drawn = [&](double threshold, double opacity) {
    return test::read(view.render(kWidth, kHeight, camera, {threshold, opacity}));
  };
  const auto lit = [&](const Image<Rgba8>& image, const glm::dvec3& patient) {
    const glm::dvec2 at = camera.project(patient, kWidth, kHeight);
    return image.at(int(at.x), int(at.y))[0] > 100;
  };
  const Image<Rgba8> ball = drawn(100, 0.5);
  CHECK(lit(ball, {14, 0, 0}));
  CHECK(!lit(ball, {-14, 0, 0}));  // not seen, though as bright
  CHECK(!lit(ball, {35, 0, 0}));   // darker
  const Image<Rgba8> tissue = drawn(20, 0.5);
  CHECK(lit(tissue, {35, 0, 0}));
  CHECK(!lit(tissue, {-35, 0, 0}));
  const Image<Rgba8> nothing = drawn(kMaxSweptThreshold, 0.5);
  CHECK(!lit(nothing, {14, 0, 0}));
  const Image<Rgba8> glass = drawn(100, 0.005);
  CHECK(!lit(glass, {14, 0, 0}));
}

TEST_CASE("a swept volume is cut at its plane, which shows its picture") {
  test::Scene::need_context();
  const HalfABall swept;
  SweptView view(swept.grey, swept.known);
  const OrbitCamera camera = from_the_front();
  // A picture whose upper half is magenta, and of which the lower half was not seen, across the line of sight.
  constexpr int kSide = 80;
  Image<Rgba8> pixels(kSide, kSide);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) pixels.at(x, y) = {255, 0, 255, std::uint8_t(y < kSide / 2 ? 255 : 0)};
  gl::Texture picture = gl::Texture::make_2d(GL_RGBA8, kSide, kSide, gl::Filter::linear);
  picture.write(GL_RGBA, GL_UNSIGNED_BYTE, pixels.pixels.data());
  UltrasoundPlane face;
  face.image = &picture;
  face.geometry = {kSide, kSide, 1, {-(kSide - 1) / 2.0, -(kSide - 1) / 2.0}};
  face.patient_from_probe.rotation = glm::dmat3({1, 0, 0}, {0, 0, -1}, {0, 1, 0});
  const auto pixel = [&](const UltrasoundPlane& cut, const glm::dvec3& patient) {
    const glm::dvec2 at = camera.project(patient, kWidth, kHeight);
    return test::read(view.render(kWidth, kHeight, camera, {100, 0.9}, cut)).at(int(at.x), int(at.y));
  };
  const glm::dvec3 above(12, 0, 10), below(12, 0, -10);
  CHECK(pixel(UltrasoundPlane(), above)[1] > 80);  // the ball's surface
  CHECK(pixel(face, above)[1] < 40);
  CHECK(pixel(face, above)[0] > 200);
  CHECK(pixel(face, below)[1] > 80);                 // the ball behind the plane
  face.patient_from_probe.translation = {0, 27, 0};  // behind the ball: nothing is left of it
  ++face.image_version;
  CHECK(pixel(face, below)[1] < 80);
}

TEST_CASE("a swept volume is drawn again only when something changes") {
  test::Scene::need_context();
  const HalfABall swept;
  SweptView view(swept.grey, swept.known);
  OrbitCamera camera = from_the_front();
  view.render(kWidth, kHeight, camera, {});
  const long first = view.renders();
  view.render(kWidth, kHeight, camera, {});
  CHECK(view.renders() == first);
  camera.orbit(10, 0);
  view.render(kWidth, kHeight, camera, {});
  CHECK(view.renders() > first);
}
