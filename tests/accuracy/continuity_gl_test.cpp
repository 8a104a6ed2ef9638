// Tests that the picture is continuous in the pose: small steps of the probe change it little, and large changes do not
// happen at once.

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>

#include "sim/core/hash.h"
#include "sim/imaging/simulator.h"
#include "sim/wein/wein_simulator.h"
#include "tests/accuracy/stressed.h"
#include "tests/imaging/parity.h"
#include "tests/imaging/real_ct.h"
#include "tests/imaging/test_body.h"
#include "tests/model/amplitudes.h"

using namespace insonate;
using namespace insonate::test;

namespace {

constexpr double kStep_mm = 0.01;

using Greys = Image<std::uint8_t>;
using Draws = std::function<Greys(const Scene&)>;

/// Returns the scene with its probe moved by `mm` along an axis, or rotated about an axis so that the depth moves by
/// `mm`. There are 12 directions, forwards and backwards; the first six are forwards.
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

/// Returns the pixel that changes most within a step in any of the first `directions` directions.
Change greatest_change(const Draws& draws, const Scene& scene, int directions) {
  Change most;
  const Greys here = draws(scene);
  for (int direction = 0; direction < directions; ++direction) {
    const Greys there = draws(moved(scene, direction, kStep_mm));
    for (std::size_t i = 0; i < here.pixels.size(); ++i) {
      const int greys = std::abs(int(here.pixels[i]) - int(there.pixels[i]));
      if (greys > most.greys) most = {greys, direction, i};
    }
  }
  return most;
}

/// Returns how much of a change occurs in the 1000th part of the step that has most of it. A jump occurs in it
/// completely.
int at_once(const Draws& draws, const Scene& scene, const Change& change) {
  const auto grey_at = [&](double mm) { return int(draws(moved(scene, change.direction, mm)).pixels[change.pixel]); };
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

/// Limits in grey levels: of a whole step, and of what may occur at once.
struct Bound {
  int step, at_once = step / 10;
};

void check_continuity(const Draws& draws, const Scene& scene, const Bound& bound, int& most, int directions = 12) {
  const Change change = greatest_change(draws, scene, directions);
  CAPTURE(change.direction, change.pixel);
  CHECK(change.greys > 0);
  CHECK(change.greys <= bound.step);
  CHECK(at_once(draws, scene, change) <= bound.at_once);
  most = std::max(most, change.greys);
}

Draws shaders_of(Stressed& stressed) {
  return [&](const Scene& scene) { return stressed.shaders(scene).grey; };
}

/// The limits are shares of the greys over this range: over a wider one a grain that ends in 0 takes more of them.
constexpr double kRange_db = 55;

Scene over_a_body(const char* probe) {
  Scene scene;
  scene.volume = test_body();
  scene.probe = *find_probe(probe);
  scene.probe.lines = 96;
  scene.depth_mm = 120;
  scene.settings = test::trainer_with_amplitudes(scene.probe.frequency_mhz, scene.depth_mm);
  scene.settings.image_width = 320;
  scene.settings.image_height = 240;
  scene.settings.dynamic_range_db = kRange_db;
  return scene;
}

/// Checks `places` places on the skin and prints the largest change of the picture.
void check_over_skin(const char* what, const Draws& draws, Scene scene, const Bound& bound, std::uint32_t places) {
  CAPTURE(what);
  int most = 0;
  for (std::uint32_t k = 0; k < places; ++k) {
    CAPTURE(k);
    const auto drawn = [&](std::uint32_t j) { return unit_float(hash(k, j, 77u, 1u)) - 0.5; };
    scene.pose = on_the_skin(60 * drawn(0), 9 + 6 * drawn(1), 24 * drawn(2));
    check_continuity(draws, scene, bound, most);
  }
  std::printf("a step of 0.01 mm over a body, %s: at most %d grey levels\n", what, most);
}

}  // namespace

TEST_CASE("a step of 0.01 mm over a body changes no pixel by more than a fifth of the range of greys") {
  Stressed stressed;
  check_over_skin("curvilinear", shaders_of(stressed), over_a_body("curvilinear"), {51}, 12);
  check_over_skin("linear", shaders_of(stressed), over_a_body("linear"), {51}, 6);
  check_over_skin("phased", shaders_of(stressed), over_a_body("phased"), {51}, 6);
}

TEST_CASE("nor with waves, by more than half of it") {
  // Where waves cancel, a grain ends in 0, whose logarithm falls without bound: no step changes it evenly.
  Stressed stressed;
  for (const char* probe : {"curvilinear", "linear", "phased"}) {
    Scene scene = over_a_body(probe);
    scene.settings = trainer_settings(scene.probe.frequency_mhz, scene.depth_mm);
    scene.settings.electronic_noise = scene.settings.clutter = false;  // new at every pose
    scene.settings.dynamic_range_db = kRange_db;
    scene.settings.image_width = 320;
    scene.settings.image_height = 240;
    check_over_skin((std::string(probe) + ", waves").c_str(), shaders_of(stressed), scene, {127}, 6);
  }
}

TEST_CASE("nor, in the paper's own mode, whose white is the frame's brightest, by more than half of it") {
  Stressed stressed;
  for (const char* probe : {"curvilinear", "phased"}) {
    Scene scene = over_a_body(probe);
    scene.settings = paper_settings(scene.depth_mm, 512);
    scene.settings.image_width = 320;
    scene.settings.image_height = 240;
    check_over_skin((std::string(probe) + ", paper's mode").c_str(), shaders_of(stressed), scene, {127}, 6);
  }
}

TEST_CASE("nor model W's picture by more than half of it") {
  // Towards total reflection its intensity falls as (1 - c^2)^(dr/l), whose slope is unbounded. The smallest distance
  // of places in single precision makes 9 grey levels there.
  const TestContext context;
  const Scene scene = over_a_body("curvilinear");
  WeinSettings settings;
  settings.image_width = 320;
  settings.image_height = 240;
  settings.exact_filter = own_filter_is_coarse();
  gl::WeinSimulator simulator(scene.volume, scene.probe, scene.depth_mm, settings);
  check_over_skin(
      "model W", [&](const Scene& moved) { return simulator.read_stages(moved.pose).grey; }, scene, {127, 25}, 12);
}

TEST_CASE("nor that of a real CT, whose gas repeats in the dark behind it, by more than half of it") {
  if (!std::filesystem::exists(kRealCt)) {
    WARN("skipped: the real scans are not there");
    return;
  }
  const Case subject = open_case(kRealCt);
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  Scene scene = over_a_body("curvilinear");
  const TestContext context;
  gl::Simulator simulator;
  simulator.set_volume(make_acoustic_volume(subject.ct, {}, {}, table), table);
  simulator.set_probe(scene.probe, scene.depth_mm);
  simulator.set_settings(scene.settings);
  const Draws draws = [&](const Scene& moved) {
    simulator.set_pose(moved.pose);
    return simulator.read_stages().grey;
  };
  int most = 0;
  for (std::uint32_t k = 0; k < 12; ++k) {
    CAPTURE(k);
    const auto drawn = [&](std::uint32_t j) { return unit_float(hash(k, j, 55u, 1u)) - 0.5; };
    const double angle = glm::radians(90 + 120 * drawn(0));  // from the front and from both sides
    const glm::dvec3 target = subject.ct.grid.centre() + glm::dvec3(100 * drawn(1), 0, 200 * drawn(2));
    scene.pose = on_skin_of(subject, target, {std::cos(angle), std::sin(angle), 0});
    check_continuity(draws, scene, {127}, most, 6);
  }
  std::printf("a step of 0.01 mm over a real CT: at most %d grey levels\n", most);
}

TEST_CASE("nor, forwards from where the stress suite's scenes begin, by more than a tenth of it") {
  Stressed stressed;
  int most = 0;
  check_continuity(shaders_of(stressed), ordinary_scene(), {25}, most, 6);
  std::printf("a step of 0.01 mm forwards in the ordinary scene: at most %d grey levels\n", most);
}

TEST_CASE("nor, where gas and bone lie side by side in voxels of 5 mm, by more than half of it") {
  Stressed stressed;
  int most = 0;
  check_continuity(shaders_of(stressed), ordinary_scene(), {127}, most);
  for (std::uint32_t k = 0; k < 12; ++k) {
    CAPTURE(k);
    Scene scene = ordinary_scene();
    const auto drawn = [&](std::uint32_t j) { return unit_float(hash(k, j, 99u, 1u)) - 0.5; };
    scene.pose.translation += glm::dvec3(20 * drawn(0), 10 * drawn(1), 20 * drawn(2));
    const glm::dvec3 axis = glm::normalize(glm::dvec3(drawn(4), drawn(5), drawn(6) + 0.01));
    scene.pose.rotation = glm::dmat3(glm::rotate(glm::dmat4(1), 0.8 * drawn(3), axis));
    check_continuity(shaders_of(stressed), scene, {127}, most);
  }
  std::printf("a step of 0.01 mm among gas and bone: at most %d grey levels\n", most);
}
