#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

#include "sim/view/body/volume_view.h"
#include "tests/view/test_patient.h"

using namespace insonate;
using test::Scene;
using view::OrbitCamera;
using view::VolumeStyle;
using view::VolumeView;

namespace {

constexpr int kWidth = 320, kHeight = 240;

/// Bone where `is_bone` says, air elsewhere.
template <typename IsBone>
Scene bone_scene(const IsBone& is_bone) {
  return Scene(test::ct_of(test::skewed_grid(90), [&](const glm::dvec3& p) { return is_bone(p) ? 1000.0 : -1000.0; }),
               {}, {});
}

VolumeStyle only_bone() {
  VolumeStyle style;
  style.cut = style.plane = style.probe = false;
  style.skin = 0;
  return style;
}

/// Where something bright is drawn: pixels, and their mean place in pixels' edges.
struct Extent {
  double area = 0;
  glm::dvec2 centre{0.0};
};

template <typename Belongs>
Extent extent_of(const Image<Rgba8>& image, const Belongs& belongs) {
  Extent extent;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (belongs(image.at(x, y))) {
        extent.area += 1;
        extent.centre += glm::dvec2(x + 0.5, y + 0.5);
      }
  extent.centre /= std::max(extent.area, 1.0);
  return extent;
}

// The background stays below 30 of 255, and bone in full shade above 40.
bool is_bone_pixel(const Rgba8& p) {
  return p[0] > 35;
}
bool is_magenta(const Rgba8& p) {
  return p[0] > 150 && p[2] > 150 && p[1] < 60;
}

/// A transverse probe at the patient's front, and a camera that looks at its plane from the feet.
void look_at_plane_from_below(Scene& scene, OrbitCamera& camera) {
  scene.set_picture(100, 100, 1.0, {255, 0, 255, 255});
  scene.plane.patient_from_probe = {glm::dmat3(1.0), {0, -50, 0}};  // looks to the back, the marker to the left
  camera.pitch_deg = -60;
  camera.distance_mm = 500;
}

}  // namespace

// A pixel and a half: the sphere's surface lies within half a voxel of 2 mm, and a voxel has 1.1 pixels here.
TEST_CASE("a sphere's silhouette is where perspective puts it") {
  const glm::dvec3 middle(12, -8, 20);
  const double radius = 42;
  Scene scene = bone_scene([&](const auto& p) { return glm::distance(p, middle) < radius; });
  VolumeView view;
  OrbitCamera camera;
  camera.distance_mm = 800;
  for (const double yaw : {0.0, 130.0}) {
    camera.yaw_deg = yaw;
    camera.pitch_deg = yaw / 5;
    const Image<Rgba8> image =
        test::read(view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, only_bone()));
    const Extent sphere = extent_of(image, is_bone_pixel);
    const double away = glm::distance(camera.patient_from_camera().translation, middle);
    const double px_per_slope = kHeight / 2.0 / std::tan(glm::radians(camera.field_of_view_deg / 2));
    const double expected = px_per_slope * std::tan(std::asin(radius / away));
    INFO("yaw " << yaw << ": radius " << std::sqrt(sphere.area / glm::pi<double>()) << ", expected " << expected);
    CHECK(std::abs(std::sqrt(sphere.area / glm::pi<double>()) - expected) < 1.5);
    CHECK(glm::distance(sphere.centre, camera.project(middle, kWidth, kHeight)) < 1.5);
  }
}

// 6 mm is three voxels of what is drawn: empty space must be leapt over up to such a sheet, not past it.
TEST_CASE("a thin sheet of bone has no holes") {
  Scene scene = bone_scene([](const auto& p) { return std::abs(p.y + 0.3 * p.x) < 3 && glm::length(p) < 70; });
  VolumeView view;
  OrbitCamera camera;
  for (const double yaw : {0.0, 40.0, 170.0}) {
    camera.yaw_deg = yaw;
    const Image<Rgba8> image =
        test::read(view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, only_bone()));
    int holes = 0, checked = 0;
    for (int x = -60; x <= 60; x += 3)
      for (int z = -60; z <= 60; z += 3) {
        const glm::dvec3 p(x, -0.3 * x, z);
        if (glm::length(p) > 62) continue;
        const glm::dvec2 pixel = camera.project(p, kWidth, kHeight);
        holes += !is_bone_pixel(image.at(int(pixel.x), int(pixel.y)));
        ++checked;
      }
    INFO("yaw " << yaw);
    CHECK(checked > 1000);
    CHECK(holes == 0);
  }
}

// A grey level, because each kind of shader has code of its own from the driver, which may round otherwise.
TEST_CASE("fragment and compute shaders draw the same, in whole pictures and in parts") {
  Scene scene = bone_scene([](const auto& p) { return glm::length(p * glm::dvec3(1, 0.7, 0.5)) < 40; });
  OrbitCamera camera;
  look_at_plane_from_below(scene, camera);
  constexpr int kOddWidth = kWidth - 3, kOddHeight = kHeight - 5;  // no whole number of work groups
  VolumeStyle of_ct;
  of_ct.ct.emplace();
  of_ct.ct->function.points = {{100, {0.9, 0.8, 0.7}, 0.0}, {700, {1.0, 0.9, 0.8}, 0.6}};
  of_ct.cut = false;
  for (const VolumeStyle& style : {VolumeStyle(), of_ct}) {
    INFO(style.ct.has_value());
    VolumeView fragments({}, view::RayShader::fragment), groups({}, view::RayShader::compute),
        parts({}, view::RayShader::compute);
    const auto drawn = [&](VolumeView& view, const view::VolumeBudget& budget = {}) {
      return test::read(view.render(kOddWidth, kOddHeight, *scene.patient, camera, scene.plane, style, budget));
    };
    const Image<Rgba8> by_fragments = drawn(fragments), by_groups = drawn(groups);
    drawn(parts, {1e-6, 1e-6});
    CHECK(parts.scale() == 5);
    while (parts.scale() > 1) drawn(parts, {1e-6, 1e-6});
    CHECK(parts.renders() > 5);
    const Image<Rgba8> by_parts = drawn(parts, {1e-6, 1e-6});
    const auto differ = [](const Image<Rgba8>& a, const Image<Rgba8>& b) {
      int largest = 0;
      for (std::size_t i = 0; i < a.pixels.size(); ++i)
        for (std::size_t c = 0; c < 4; ++c) largest = std::max(largest, std::abs(a.pixels[i][c] - b.pixels[i][c]));
      return largest > 1;
    };
    CHECK_FALSE(differ(by_fragments, by_groups));
    CHECK(by_parts.pixels == by_groups.pixels);
    const auto larger = [&](VolumeView& view) {
      return test::read(view.render(kWidth + 20, kHeight + 9, *scene.patient, camera, scene.plane, style));
    };
    CHECK_FALSE(differ(larger(fragments), larger(groups)));
    CHECK(drawn(groups).pixels == by_groups.pixels);
    CHECK(extent_of(by_groups, is_bone_pixel).area > 500);
  }
}

TEST_CASE("left and right, head and feet are where they belong") {
  Scene scene = bone_scene(
      [](const auto& p) { return glm::all(glm::lessThan(glm::abs(p - glm::dvec3(50, 0, 30)), glm::dvec3(9))); });
  VolumeView view;
  OrbitCamera camera;
  const auto centre = [&](double yaw) {
    camera.yaw_deg = yaw;
    const Extent block = extent_of(
        test::read(view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, only_bone())), is_bone_pixel);
    REQUIRE(block.area > 20);
    return block.centre;
  };
  CHECK(centre(0).x > kWidth / 2.0 + 5);    // the patient's left is on the right, seen from the front
  CHECK(centre(180).x < kWidth / 2.0 - 5);  // and on the left from behind
  CHECK(centre(0).y < kHeight / 2.0 - 5);   // towards the head
}

TEST_CASE("the picture is seen where it lies, and hidden behind bone in front of it") {
  const auto slab = [](double z_mm) {
    return
        [z_mm](const glm::dvec3& p) { return std::abs(p.z - z_mm) < 6 && p.x > 0 && p.x < 70 && std::abs(p.y) < 60; };
  };
  VolumeStyle style = only_bone();
  style.plane = true;
  OrbitCamera camera;
  const auto picture = [&](Scene& scene) {
    look_at_plane_from_below(scene, camera);
    VolumeView view;
    return extent_of(test::read(view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, style)), is_magenta);
  };
  Scene behind = bone_scene(slab(25));
  const Extent whole = picture(behind);
  const glm::dvec2 a = camera.project({-50, -50, 0}, kWidth, kHeight),
                   b = camera.project({50, -50, 0}, kWidth, kHeight);
  const glm::dvec2 c = camera.project({50, 50, 0}, kWidth, kHeight), d = camera.project({-50, 50, 0}, kWidth, kHeight);
  const auto cross = [](const glm::dvec2& u, const glm::dvec2& v) { return std::abs(u.x * v.y - u.y * v.x); };
  const double expected_area = cross(c - a, d - b) / 2;
  // Its blue edge takes a pixel or two all around.
  CHECK(whole.area < expected_area);
  CHECK(whole.area >
        expected_area - 2 * (glm::distance(a, b) + glm::distance(b, c) + glm::distance(c, d) + glm::distance(d, a)));
  CHECK(glm::distance(whole.centre, (a + b + c + d) / 4.0) < 4);

  Scene in_front = bone_scene(slab(-12));
  const Extent half = picture(in_front);
  CHECK(half.area < 0.65 * whole.area);
  CHECK(half.area > 0.35 * whole.area);
  CHECK(half.centre.x < kWidth / 2.0 - 10);  // what is left is on the patient's right

  SECTION("the cut takes away what hides it") {
    style.cut = true;
    CHECK(picture(in_front).area == Approx(whole.area).epsilon(0.01));
    // A slab on the far side stays.
    look_at_plane_from_below(behind, camera);
    style.plane = false;
    style.cut_face = 0;
    VolumeView view;
    CHECK(
        extent_of(test::read(view.render(kWidth, kHeight, *behind.patient, camera, behind.plane, style)), is_bone_pixel)
            .area > 1000);
    look_at_plane_from_below(in_front, camera);
    CHECK(extent_of(test::read(view.render(kWidth, kHeight, *in_front.patient, camera, in_front.plane, style)),
                    is_bone_pixel)
              .area < 20);
  }
}

TEST_CASE("outside the fan there is no picture") {
  Scene scene = bone_scene([](const auto& p) { return glm::length(p) < 5; });
  OrbitCamera camera;
  look_at_plane_from_below(scene, camera);
  VolumeStyle style = only_bone();
  style.plane = true;
  style.organs = false;
  VolumeView view;
  const auto area = [&] {
    return extent_of(test::read(view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, style)), is_magenta);
  };
  const Extent whole = area();
  scene.set_picture(100, 100, 1.0, {255, 0, 255, 255}, [](int x, int) { return x >= 50; });
  const Extent left_half = area();
  CHECK(left_half.area == Approx(whole.area / 2).epsilon(0.05));
  CHECK(left_half.centre.x > kWidth / 2.0);  // +x of the probe is the patient's left, here the right of the view
}

TEST_CASE("skin shows what is within") {
  const auto hu = [](const glm::dvec3& p) {
    return glm::length(p) < 20 ? 1000.0 : glm::length(p) < 60 ? 30.0 : -1000.0;
  };
  Scene scene(test::ct_of(test::skewed_grid(90), hu), {}, {});
  OrbitCamera camera;
  VolumeStyle style = only_bone();
  VolumeView view;
  const auto brightness = [&](int right_of_centre, bool organs) {
    style.organs = organs;
    const Image<Rgba8> image = test::read(view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, style));
    return double(image.at(kWidth / 2 + right_of_centre, kHeight / 2)[0]);
  };
  const double background = brightness(20, true), bone = brightness(0, true) - brightness(0, false);
  REQUIRE(bone > 60);
  style.skin = 0.2;
  CHECK(brightness(20, true) > background + 10);
  // Of the bone's light the skin lets 1 - 0.2 through, face on; behind the bone its far side is missing.
  CHECK((brightness(0, true) - brightness(0, false)) / bone == Approx(0.8).margin(0.15));
}

// A sphere's own shade bends by 0.9 levels over 3 pixels to either side, and the skin's by 2.5. The gradient of the
// body's share, which is smoothed less, bends it by 9.8: lines along the voxels.
TEST_CASE("a ball's skin has a smooth shade, without the voxels' layers") {
  Scene scene(test::ct_of(test::skewed_grid(90), [](const auto& p) { return glm::length(p) < 60 ? 30.0 : -1000.0; }),
              {}, {});
  OrbitCamera camera;
  camera.distance_mm = 500;
  VolumeStyle style = only_bone();
  style.skin = 1;
  VolumeView view;
  const Image<Rgba8> image = test::read(view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, style));
  const double radius =
      0.5 * glm::distance(camera.project({0, 0, 60}, kWidth, kHeight), camera.project({0, 0, 0}, kWidth, kHeight));
  double squares = 0, count = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      if (glm::length(glm::dvec2(x - kWidth / 2, y - kHeight / 2)) > radius) continue;
      const double bend = image.at(x - 3, y)[0] - 2 * image.at(x, y)[0] + image.at(x + 3, y)[0];
      squares += bend * bend;
      ++count;
    }
  REQUIRE(count > 1000);
  CHECK(std::sqrt(squares / count) < 4);
}

TEST_CASE("a closed body shows nothing within where the CT ends") {
  const Grid grid = test::skewed_grid(60);
  const auto scene_with = [&](double within) {
    return Scene(test::ct_of(grid,
                             [&](const glm::dvec3& p) {
                               const glm::dvec3 local = glm::transpose(grid.direction) * p;
                               const double from_axis = glm::length(glm::dvec2(local));
                               return from_axis < 20 ? within : from_axis < 40 ? 30.0 : -1000.0;
                             }),
                 {}, {});
  };
  VolumeStyle style = only_bone();
  style.skin = 1;
  const auto seen = [&](double within, double side) {
    Scene scene = scene_with(within);
    OrbitCamera camera;
    camera.distance_mm = 400;
    const glm::dvec3 from = side * grid.direction[2];
    camera.yaw_deg = glm::degrees(std::atan2(from.x, -from.y));
    camera.pitch_deg = glm::degrees(std::asin(from.z));
    VolumeView view;
    return test::read(view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, style));
  };
  for (const double side : {-1.0, 1.0}) {
    const Image<Rgba8> bone = seen(1000, side), soft = seen(30, side);
    CHECK((bone.pixels == soft.pixels));
    CHECK(bone.at(kWidth / 2, kHeight / 2)[0] > 60);
    CHECK(bone.at(kWidth / 2, kHeight / 2) == bone.at(kWidth / 2 + 20, kHeight / 2));
  }
}

TEST_CASE("the probe stands on the skin with its marker on the side of the picture's right edge") {
  Scene scene = bone_scene([](const auto& p) { return glm::length(p) < 5; });
  OrbitCamera camera;
  look_at_plane_from_below(scene, camera);
  scene.plane.probe = *find_probe("linear");
  camera.pitch_deg = -45;
  VolumeStyle style = only_bone();
  style.probe = true;
  VolumeView view;
  const Image<Rgba8> image = test::read(view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, style));
  const Extent marker = extent_of(image, [](const Rgba8& p) { return p[1] > 1.5 * p[0] && p[1] > 60; });
  REQUIRE(marker.area > 5);
  const glm::dvec3 place = scene.plane.patient_from_probe.point({scene.plane.probe.width_mm / 2 + 1, -14, 0});
  CHECK(glm::distance(marker.centre, camera.project(place, kWidth, kHeight)) < 3);
}
