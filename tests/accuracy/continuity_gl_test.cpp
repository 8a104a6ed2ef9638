// The picture is continuous in the pose: small steps of the probe change it little, and what changes much does not do
// so at once.

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cstdio>
#include <cstdlib>

#include "sim/core/hash.h"
#include "tests/accuracy/stressed.h"
#include "tests/gl/test_body.h"

using namespace insonate;
using namespace insonate::test;

namespace {

constexpr double kStep_mm = 0.01;

/// The scene with its probe moved along an axis, or turned about one as much as moves the depth by so many mm; both to
/// and fro: 12 directions, of which the first six are forwards.
Scene moved(const Scene& scene, int direction, double mm) {
  Scene result = scene;
  glm::dvec3 axis(0);
  axis[direction % 3] = direction < 6 ? 1 : -1;
  if (direction % 6 < 3)
    result.pose.translation += mm * axis;
  else
    result.pose.rotation *= glm::dmat3(glm::rotate(glm::dmat4(1), mm / scene.depth_mm, axis));
  return result;
}

struct Change {
  int greys = 0, direction = 0;
  std::size_t pixel = 0;
};

/// The pixel that changes most within a step in any of the first so many directions.
Change greatest_change(Stressed& stressed, const Scene& scene, int directions) {
  Change most;
  const Stages<float> here = stressed.shaders(scene);
  for (int direction = 0; direction < directions; ++direction) {
    const Stages<float> there = stressed.shaders(moved(scene, direction, kStep_mm));
    REQUIRE(here.inside.pixels == there.inside.pixels);
    for (std::size_t i = 0; i < here.grey.pixels.size(); ++i) {
      const int greys = std::abs(int(here.grey.pixels[i]) - int(there.grey.pixels[i]));
      if (greys > most.greys) most = {greys, direction, i};
    }
  }
  return most;
}

/// What is left of a change in the 1000th part of the step that has most of it: of a jump, all.
int at_once(Stressed& stressed, const Scene& scene, const Change& change) {
  const auto grey_at = [&](double mm) {
    return int(stressed.shaders(moved(scene, change.direction, mm)).grey.pixels[change.pixel]);
  };
  double from_mm = 0, to_mm = kStep_mm;
  int from = grey_at(from_mm), to = grey_at(to_mm);
  while (to_mm - from_mm > kStep_mm / 1000) {
    const double middle_mm = (from_mm + to_mm) / 2;
    const int middle = grey_at(middle_mm);
    const bool first_half = std::abs(middle - from) > std::abs(to - middle);
    (first_half ? to_mm : from_mm) = middle_mm;
    (first_half ? to : from) = middle;
  }
  return std::abs(to - from);
}

/// @param bound  grey levels, of a step; a tenth of it may come at once
void check_continuity(Stressed& stressed, const Scene& scene, int bound, int& most, int directions = 12) {
  const Change change = greatest_change(stressed, scene, directions);
  CAPTURE(change.direction, change.pixel);
  CHECK(change.greys > 0);
  CHECK(change.greys <= bound);
  CHECK(at_once(stressed, scene, change) <= bound / 10);
  most = std::max(most, change.greys);
}

}  // namespace

TEST_CASE("a step of 0.01 mm over a body changes no pixel by more than a fifth of the range of greys") {
  Stressed stressed;
  Scene scene;
  scene.volume = test_body();
  scene.probe = *find_probe("curvilinear");
  scene.probe.lines = 96;
  scene.depth_mm = 120;
  scene.settings = trainer_settings(3.5, scene.depth_mm);
  scene.settings.image_width = 320;
  scene.settings.image_height = 240;
  int most = 0;
  for (std::uint32_t k = 0; k < 12; ++k) {
    CAPTURE(k);
    const auto drawn = [&](std::uint32_t j) { return unit_float(hash(k, j, 77u, 1u)) - 0.5; };
    scene.pose = on_the_skin(60 * drawn(0), 9 + 6 * drawn(1), 24 * drawn(2));
    check_continuity(stressed, scene, 51, most);
  }
  std::printf("a step of 0.01 mm over a body: at most %d grey levels\n", most);
}

TEST_CASE("nor, forwards from where the stress suite's scenes begin, by more than a tenth of it") {
  Stressed stressed;
  int most = 0;
  check_continuity(stressed, ordinary_scene(), 25, most, 6);
  std::printf("a step of 0.01 mm forwards in the ordinary scene: at most %d grey levels\n", most);
}

TEST_CASE("nor, where gas and bone lie side by side in voxels of 5 mm, by more than half of it") {
  Stressed stressed;
  int most = 0;
  check_continuity(stressed, ordinary_scene(), 127, most);
  for (std::uint32_t k = 0; k < 12; ++k) {
    CAPTURE(k);
    Scene scene = ordinary_scene();
    const auto drawn = [&](std::uint32_t j) { return unit_float(hash(k, j, 99u, 1u)) - 0.5; };
    scene.pose.translation += glm::dvec3(20 * drawn(0), 10 * drawn(1), 20 * drawn(2));
    const glm::dvec3 axis = glm::normalize(glm::dvec3(drawn(4), drawn(5), drawn(6) + 0.01));
    scene.pose.rotation = glm::dmat3(glm::rotate(glm::dmat4(1), 0.8 * drawn(3), axis));
    check_continuity(stressed, scene, 127, most);
  }
  std::printf("a step of 0.01 mm among gas and bone: at most %d grey levels\n", most);
}
