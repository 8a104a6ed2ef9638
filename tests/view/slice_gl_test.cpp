#include <catch2/catch.hpp>

#include <algorithm>

#include "sim/view/slice_view.h"
#include "tests/view/test_patient.h"

using namespace insonate;
using test::Scene;
using view::SliceStyle;
using view::SliceView;

namespace {

constexpr int kWidth = 200, kHeight = 160;

double ramp_hu(const glm::dvec3& p) {
  return 40 + 1.1 * p.x - 0.7 * p.y + 1.6 * p.z;
}

/// A ramp of density under an oblique plane; the picture's left half is inside the fan.
Scene ramp_scene(const Volume<std::uint8_t>& labels = {}, const view::OrganColours& colours = {}) {
  Scene scene(test::ct_of(test::skewed_grid(80), ramp_hu), labels, colours);
  scene.set_picture(kWidth, kHeight, 0.4, {200, 200, 200, 255}, [](int x, int) { return x < kWidth / 2; });
  scene.plane.patient_from_probe = {glm::dmat3(glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(0.2, -1, 0.4))),
                                    {5, -20, 10}};
  return scene;
}

double expected_grey(const Scene& scene, int x, int y, const SliceStyle& style) {
  const glm::dvec3 p = scene.plane.patient_from_probe.point({scene.plane.geometry.plane_mm(x, y), 0});
  return 255 * std::clamp((ramp_hu(p) - style.level_hu) / style.window_hu + 0.5, 0.0, 1.0);
}

/// The largest difference to `expected(x, y)`, which gives grey levels.
template <typename Expected>
double worst_difference(const Image<Rgba8>& image, const Expected& expected) {
  double worst = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(image.at(x, y)[std::size_t(c)] - expected(x, y)));
  return worst;
}

}  // namespace

// One grey level: voxels hold whole HU, of which this window has 1.2 a level, and rounding to a level adds a half.
TEST_CASE("a slice shows the density at each pixel's place in the patient") {
  Scene scene = ramp_scene();
  SliceView view;
  SliceStyle style;
  style.window_hu = 300;
  style.outside_fan = 1;
  const Image<Rgba8> image = test::read(view.render(*scene.patient, scene.plane, style));
  REQUIRE(image.width == kWidth);
  REQUIRE(image.height == kHeight);
  CHECK(worst_difference(image, [&](int x, int y) { return expected_grey(scene, x, y, style); }) <=
        1.0 + test::of_filter(0.25));
  CHECK(image.at(3, 3)[3] == 255);
}

TEST_CASE("outside the patient's volume a slice is black") {
  Scene scene = ramp_scene();
  scene.plane.patient_from_probe.translation = {0, 500, 0};
  SliceView view;
  CHECK(worst_difference(test::read(view.render(*scene.patient, scene.plane)), [](int, int) { return 0.0; }) == 0);
}

TEST_CASE("the blend mixes inside the fan and dims the CT outside it") {
  Scene scene = ramp_scene();
  SliceView view;
  SliceStyle style;
  style.ultrasound = 0.25;
  style.outside_fan = 0.5;
  const Image<Rgba8> image = test::read(view.render(*scene.patient, scene.plane, style));
  const auto expected = [&](int x, int y) {
    const double ct = expected_grey(scene, x, y, style);
    return x < kWidth / 2 ? 0.75 * ct + 0.25 * 200 : 0.5 * ct;
  };
  CHECK(worst_difference(image, expected) <= 1.0);
}

TEST_CASE("the blend's ultrasound has the colour that is asked for, and the CT stays grey") {
  Scene scene = ramp_scene();
  SliceView view;
  SliceStyle style;
  style.ultrasound = 0.5;
  style.outside_fan = 1;
  style.ultrasound_white = {1.0f, 0.5f, 0.0f};
  const Image<Rgba8> image = test::read(view.render(*scene.patient, scene.plane, style));
  for (const int y : {20, 100}) {
    const double ct = expected_grey(scene, 30, y, style);
    CHECK(std::abs(image.at(30, y)[0] - (0.5 * ct + 0.5 * 200)) <= 1.0);
    CHECK(std::abs(image.at(30, y)[1] - (0.5 * ct + 0.5 * 100)) <= 1.0);
    CHECK(std::abs(image.at(30, y)[2] - 0.5 * ct) <= 1.0);
    CHECK(image.at(150, y)[0] == image.at(150, y)[2]);
  }
}

TEST_CASE("outlines run along a label's edge inside it, in its organ's colour, and only where asked for") {
  Volume<std::uint8_t> labels{test::skewed_grid(80), {}};
  view::OrganColours colours{};
  colours[9] = {{0.1f, 0.7f, 0.2f}, 0.5f};
  const double radius = 15;
  const glm::dvec3 middle(5, -5, 12);
  for (const auto hu :
       test::ct_of(labels.grid, [&](const auto& p) { return glm::distance(p, middle) < radius; }).voxels)
    labels.voxels.push_back(hu ? 9 : 0);
  Scene scene = ramp_scene(labels, colours);
  SliceView view;
  SliceStyle style;
  style.outside_fan = 1;
  const Image<Rgba8> plain = test::read(view.render(*scene.patient, scene.plane, style));
  style.outlined = {9};
  const Image<Rgba8> outlined = test::read(view.render(*scene.patient, scene.plane, style));
  style.outlined = {8};
  CHECK(test::read(view.render(*scene.patient, scene.plane, style)).pixels == plain.pixels);

  int on_edge = 0, off_edge = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      if (outlined.at(x, y) == plain.at(x, y)) continue;
      const glm::dvec3 p = scene.plane.patient_from_probe.point({scene.plane.geometry.plane_mm(x, y), 0});
      // Half the voxels' diagonal of steps, and the line's own width.
      const bool near_edge = std::abs(glm::distance(p, middle) - radius) < 1.4 + 1.5 * 0.4 * 2;
      ++(near_edge ? on_edge : off_edge);
      CHECK(outlined.at(x, y)[1] > outlined.at(x, y)[0]);
    }
  CHECK(off_edge == 0);
  CHECK(on_edge > 100);
}

TEST_CASE("a slice is drawn anew only when something changed, and leaves the state of the context alone") {
  Scene scene = ramp_scene();
  SliceView view;
  SliceStyle style;
  glViewport(3, 4, 50, 60);
  glEnable(GL_BLEND);
  const auto renders_after = [&] {
    view.render(*scene.patient, scene.plane, style);
    return view.renders();
  };
  CHECK(renders_after() == 1);
  CHECK(renders_after() == 1);
  style.level_hu = 60;
  CHECK(renders_after() == 2);
  ++scene.plane.image_version;
  CHECK(renders_after() == 3);
  scene.plane.patient_from_probe.translation.x += 0.1;
  CHECK(renders_after() == 4);
  CHECK(renders_after() == 4);
  view.forget();
  CHECK(renders_after() == 5);

  GLint viewport[4] = {}, framebuffer = -1;
  glGetIntegerv(GL_VIEWPORT, viewport);
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
  CHECK(std::equal(viewport, viewport + 4, std::array<GLint, 4>{3, 4, 50, 60}.begin()));
  CHECK(framebuffer == 0);
  CHECK(glIsEnabled(GL_BLEND));
}
