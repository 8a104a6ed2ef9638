// Surfaces of labelled structures within the CT, from where a sphere is known to lie.

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "sim/view/body/ct_reference.h"
#include "sim/view/body/volume_view.h"
#include "tests/view/test_patient.h"

using namespace insonate;
using namespace insonate::view;
using test::Scene;

namespace {

constexpr int kWidth = 96, kHeight = 72;
constexpr std::uint8_t kRedBall = 3, kBlueBall = 9;

struct Sphere {
  glm::dvec3 centre;
  double radius;

  /// Returns where a ray enters, mm from its start; nothing if it misses.
  std::optional<double> entry(const glm::dvec3& start, const glm::dvec3& direction) const {
    const glm::dvec3 to = centre - start;
    const double along = glm::dot(to, direction), aside = glm::length(to - along * direction);
    return aside < radius ? std::optional(along - std::sqrt(radius * radius - aside * aside)) : std::nullopt;
  }
  /// Returns how closely a ray passes the rim, mm.
  double from_rim(const glm::dvec3& start, const glm::dvec3& direction) const {
    const glm::dvec3 to = centre - start;
    return std::abs(glm::length(to - glm::dot(to, direction) * direction) - radius);
  }
};

constexpr double kFar = 1e9;
const Sphere kTissue{{-14, 0, 4}, 24}, kRed{{12, 6, -2}, 20}, kBlue{{0, -22, 10}, 16};

Volume<std::uint8_t> blank_labels(const Grid& grid) {
  Volume<std::uint8_t> labels;
  labels.grid = grid;
  labels.voxels.resize(grid.count());
  return labels;
}

/// A green ball of tissue, and two labelled balls that it hides in part.
struct Balls {
  Volume<std::int16_t> ct = test::ct_of(test::skewed_grid(50), [](const glm::dvec3& p) {
    return std::clamp(500 * (kTissue.radius - glm::distance(p, kTissue.centre)), -1000.0, 1000.0);
  });
  Volume<std::uint8_t> labels = blank_labels(ct.grid);
  OrganColours colours{};
  std::optional<Scene> scene;

  Balls() {
    for (int k = 0; k < ct.grid.size.z; ++k)
      for (int j = 0; j < ct.grid.size.y; ++j)
        for (int i = 0; i < ct.grid.size.x; ++i) {
          const glm::dvec3 p = ct.grid.patient_from_index({i, j, k});
          if (glm::distance(p, kBlue.centre) < kBlue.radius) labels.at({i, j, k}) = kBlueBall;
          if (glm::distance(p, kRed.centre) < kRed.radius) labels.at({i, j, k}) = kRedBall;
        }
    colours[kRedBall] = {{1, 0, 0}, 0.5f};
    colours[kBlueBall] = {{0, 0, 1}, 0.5f};
    scene.emplace(ct, labels, colours);
  }

  static VolumeStyle style(std::vector<std::uint8_t> structures) {
    VolumeStyle style;
    style.cut = style.plane = style.probe = false;
    style.ct.emplace();
    style.ct->function = {"", {{0, {0, 1, 0}, 0}, {1, {0, 1, 0}, kMaxOpacity}}};
    style.ct->structures = std::move(structures);
    style.ct->structure_opacity = 1;
    style.ct->body_only = false;
    return style;
  }
};

OrbitCamera random_camera(std::mt19937& random) {
  std::uniform_real_distribution<double> yaw(-180, 180), pitch(-89, 89), distance(220, 400);
  OrbitCamera camera;
  camera.yaw_deg = yaw(random);
  camera.pitch_deg = pitch(random);
  camera.distance_mm = distance(random);
  return camera;
}

bool shows(const Rgba8& pixel, std::size_t channel) {
  for (std::size_t other = 0; other < 3; ++other)
    if (other != channel && pixel[channel] < 1.5 * pixel[other] + 10) return false;
  return true;
}

}  // namespace

// Labels have voxels of up to 2 mm, and smoothing rounds their steps within one of them: rays that pass a rim, or meet
// two surfaces, within 2.5 mm of each other may show either.
TEST_CASE("from any side, structures, tissue and the plane hide each other as their depths say") {
  Balls balls;
  Scene& scene = *balls.scene;
  scene.set_picture(110, 110, 1.0, {255, 0, 255, 255});
  VolumeStyle style = Balls::style({kRedBall});
  style.plane = true;
  VolumeView view;
  std::mt19937 random(5);
  constexpr double kMargin = 2.5;
  int red = 0, red_hidden = 0, blue_left_out = 0, plane_before_red = 0;
  for (int round = 0; round < 50; ++round) {
    const OrbitCamera camera = random_camera(random);
    std::uniform_real_distribution<double> aside(-30, 30);
    const glm::dmat3 turned(glm::rotate(glm::dmat4(1.0), glm::radians(6 * aside(random)),
                                        glm::normalize(glm::dvec3(0.4, aside(random), 9))));
    scene.plane.patient_from_probe = {turned, turned * glm::dvec3(0, -55, aside(random))};
    view.forget();
    const Image<Rgba8> drawn = test::read(view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, style));
    const CtReference rays(balls.ct, *style.ct, camera, kWidth, kHeight, 1);
    const Pose probe_from_patient = scene.plane.patient_from_probe.inverse();
    for (int y = 2; y < kHeight; y += 2)
      for (int x = 2; x < kWidth; x += 2) {
        const glm::dvec3 ray = rays.direction(x + 0.5, y + 0.5), eye = rays.eye();
        if (std::min({kTissue.from_rim(eye, ray), kRed.from_rim(eye, ray), kBlue.from_rim(eye, ray)}) < kMargin)
          continue;
        const double tissue_at = kTissue.entry(eye, ray).value_or(kFar), red_at = kRed.entry(eye, ray).value_or(kFar);
        const glm::dvec3 from = probe_from_patient.point(eye), along = probe_from_patient.direction(ray);
        const double to_plane = -from.z / along.z;
        const glm::dvec3 hit = from + to_plane * along;
        if (std::max(std::abs(hit.x), std::abs(hit.y - 55)) > 48 &&
            std::max(std::abs(hit.x), std::abs(hit.y - 55)) < 62)
          continue;  // near the picture's edge
        const bool on_picture = to_plane > 0 && std::max(std::abs(hit.x), std::abs(hit.y - 55)) < 55;
        const double plane_at = on_picture ? to_plane : kFar;
        const Rgba8& pixel = drawn.at(x, y);
        INFO("camera " << round << ", pixel " << x << ", " << y);
        if (red_at + kMargin < std::min(tissue_at, plane_at)) {
          CHECK(shows(pixel, 0));
          ++red;
        } else if (red_at < kFar && red_at > std::min(tissue_at, plane_at) + kMargin) {
          CHECK(!shows(pixel, 0));
          ++(tissue_at < plane_at ? red_hidden : plane_before_red);
        } else if (kBlue.entry(eye, ray) && red_at == kFar) {
          CHECK(!shows(pixel, 2));  // it is not chosen
          ++blue_left_out;
        }
      }
  }
  CHECK(red > 300);
  CHECK(red_hidden > 300);
  CHECK(plane_before_red > 100);
  CHECK(blue_left_out > 300);
}

TEST_CASE("structures are drawn where a ray leaps, and as they are without leaps") {
  Balls balls;
  VolumeView view;
  std::mt19937 random(6);
  int different_from_background = 0;
  for (int round = 0; round < 20; ++round) {
    VolumeStyle style = Balls::style({kBlueBall, kRedBall});
    style.ct->function.points.clear();  // no tissue at all
    style.ct->step = round % 2 ? 0.37 : 0.9;
    style.ct->structure_opacity = 0.6;
    const OrbitCamera camera = random_camera(random);
    const auto draw = [&](bool skips) {
      style.ct->skips_empty = skips;
      view.forget();
      return test::read(view.render(kWidth, kHeight, *balls.scene->patient, camera, balls.scene->plane, style));
    };
    const Image<Rgba8> with = draw(true), without = draw(false);
    int greatest = 0;
    for (std::size_t i = 0; i < with.pixels.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        greatest = std::max(greatest, std::abs(int(with.pixels[i][c]) - int(without.pixels[i][c])));
    INFO("round " << round);
    CHECK(greatest <= 1);
    for (const Rgba8& pixel : with.pixels) different_from_background += pixel[0] > 100 || pixel[2] > 100;
  }
  CHECK(different_from_background > 1000);
}

TEST_CASE("each structure is switched by itself, and at once") {
  Balls balls;
  VolumeView view;
  OrbitCamera camera;
  camera.distance_mm = 300;
  const auto seen = [&](std::vector<std::uint8_t> structures) {
    VolumeStyle style = Balls::style(std::move(structures));
    style.ct->function.points.clear();
    const Image<Rgba8> drawn =
        test::read(view.render(kWidth, kHeight, *balls.scene->patient, camera, balls.scene->plane, style));
    int red = 0, blue = 0;
    for (const Rgba8& pixel : drawn.pixels) {
      red += shows(pixel, 0);
      blue += shows(pixel, 2);
    }
    return std::pair(red > 40, blue > 40);
  };
  CHECK(seen({}) == std::pair(false, false));
  CHECK(seen({kRedBall}) == std::pair(true, false));
  CHECK(seen({kBlueBall}) == std::pair(false, true));
  CHECK(seen({kBlueBall, kRedBall}) == std::pair(true, true));
  CHECK(seen({}) == std::pair(false, false));
}
