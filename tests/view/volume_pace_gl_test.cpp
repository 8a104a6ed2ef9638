#include <catch2/catch.hpp>

#include "sim/view/volume_view.h"
#include "tests/view/test_patient.h"

using namespace insonate;
using test::Scene;
using view::OrbitCamera;
using view::VolumeView;

namespace {

constexpr int kWidth = 200, kHeight = 150;
constexpr double kUnlimited = std::numeric_limits<double>::infinity();
// What no device keeps, and what each does: budgets that make the choice independent of the machine.
constexpr double kHopeless_ms = 1e-9, kAmple_ms = 1e9;

Scene small_patient() {
  Scene scene(test::ct_of(test::skewed_grid(60),
                          [](const auto& p) {
                            return glm::length(p) < 15 ? 800.0 : glm::length(p) < 50 ? 20.0 : -1000.0;
                          }),
              {}, {});
  scene.set_picture(80, 60, 1.0, {90, 120, 150, 255});
  scene.plane.patient_from_probe.translation = {0, -50, 0};
  return scene;
}

}  // namespace

TEST_CASE("Nothing is drawn while nothing changes, and each change is drawn") {
  Scene scene = small_patient();
  VolumeView view;
  OrbitCamera camera;
  view::VolumeStyle style;
  int width = kWidth;
  const auto renders_after = [&] {
    view.render(width, kHeight, *scene.patient, camera, scene.plane, style, kUnlimited);
    return view.renders();
  };
  CHECK(renders_after() == 1);
  CHECK(renders_after() == 1);
  camera.orbit(1, 0);
  CHECK(renders_after() == 2);
  scene.plane.patient_from_probe.translation.z += 1;
  CHECK(renders_after() == 3);
  ++scene.plane.image_version;
  CHECK(renders_after() == 4);
  style.skin = 0.5;
  CHECK(renders_after() == 5);
  scene.plane.probe.field_of_view_deg = 70;
  CHECK(renders_after() == 6);
  width = 210;
  CHECK(renders_after() == 7);
  CHECK(renders_after() == 7);
  view.forget();
  CHECK(renders_after() == 8);
  CHECK(view.scale() == 1);
}

TEST_CASE("While things move the picture is as coarse as the budget asks, and sharp once they rest") {
  Scene scene = small_patient();
  VolumeView view, unhurried;
  OrbitCamera camera;
  const auto render = [&](double budget_ms) -> const gl::Texture& {
    return view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, {}, budget_ms);
  };
  render(kHopeless_ms);
  CHECK(view.scale() == 4);
  camera.orbit(5, 0);
  CHECK(render(kHopeless_ms).width() == kWidth / 4);
  camera.orbit(5, 0);
  CHECK(render(kAmple_ms).width() == kWidth);
  CHECK(view.scale() == 1);
  CHECK(view.full_picture_ms() > 0);

  camera.orbit(5, 0);
  render(kHopeless_ms);
  const long moving = view.renders();
  int calls = 0;
  while (view.scale() != 1 && calls < 1000) {
    render(kHopeless_ms);
    ++calls;
  }
  CHECK(calls > 10);  // in parts, each short
  CHECK(calls < 100);
  CHECK(view.renders() == moving + calls);
  const auto refined = test::read(render(kHopeless_ms)).pixels;
  CHECK(view.renders() == moving + calls);
  CHECK(refined ==
        test::read(unhurried.render(kWidth, kHeight, *scene.patient, camera, scene.plane, {}, kUnlimited)).pixels);
}

TEST_CASE("A coarse picture shows the same as the sharp one") {
  Scene scene = small_patient();
  VolumeView coarse, sharp;
  const auto small = test::read(coarse.render(kWidth, kHeight, *scene.patient, {}, scene.plane, {}, kHopeless_ms));
  const auto full = test::read(sharp.render(kWidth, kHeight, *scene.patient, {}, scene.plane, {}, kUnlimited));
  const int scale = coarse.scale();
  REQUIRE(scale == 4);
  double difference = 0;
  for (int y = 0; y < kHeight / scale; ++y)
    for (int x = 0; x < small.width; ++x) {
      double mean = 0;
      for (int j = 0; j < scale; ++j)
        for (int i = 0; i < scale; ++i) mean += full.at(x * scale + i, y * scale + j)[0];
      difference += std::abs(mean / (scale * scale) - small.at(x, y)[0]);
    }
  // Steps are longer and edges fall between pixels; a picture shifted by half a coarse pixel differs by twice as much.
  CHECK(difference / (double(small.width) * (kHeight / scale)) < 3.0);
}

TEST_CASE("The volume view leaves the state of the context alone") {
  Scene scene = small_patient();
  VolumeView view;
  glViewport(1, 2, 33, 44);
  glEnable(GL_SCISSOR_TEST);
  glScissor(5, 6, 7, 8);
  view.render(kWidth, kHeight, *scene.patient, {}, scene.plane);
  GLint viewport[4] = {}, scissor[4] = {}, framebuffer = -1;
  glGetIntegerv(GL_VIEWPORT, viewport);
  glGetIntegerv(GL_SCISSOR_BOX, scissor);
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
  CHECK(std::equal(viewport, viewport + 4, std::array<GLint, 4>{1, 2, 33, 44}.begin()));
  CHECK(std::equal(scissor, scissor + 4, std::array<GLint, 4>{5, 6, 7, 8}.begin()));
  CHECK(framebuffer == 0);
  CHECK(glIsEnabled(GL_SCISSOR_TEST));
}
