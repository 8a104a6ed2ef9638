// The CT drawn by direct volume rendering, compared with the reference and with what can be computed by hand.

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <random>

#include "sim/view/body/classified_ct.h"
#include "sim/view/body/ct_reference.h"
#include "sim/view/body/volume_view.h"
#include "tests/view/test_patient.h"

using namespace insonate;
using namespace insonate::view;
using test::Scene;

namespace {

constexpr int kWidth = 96, kHeight = 72;

/// The CT alone, with the samples where the reference has them.
VolumeStyle style_of(TransferFunction function) {
  VolumeStyle style;
  style.cut = style.plane = style.probe = false;
  style.ct.emplace();
  style.ct->function = std::move(function);
  style.ct->jittered = style.ct->body_only = false;
  return style;
}

/// A function that shows all above a value, opaque within a voxel.
TransferFunction above(double hu, const glm::dvec3& colour = {0.9, 0.8, 0.7}) {
  return {"", {{hu, colour, 0}, {hu + 1, colour, kMaxOpacity}}};
}

/// Smooth blobs of tissue in air: sums of Gaussians.
Volume<std::int16_t> random_ct(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-45, 45), size(10, 28), height(300, 2200);
  struct Blob {
    glm::dvec3 centre;
    double sigma_mm, hu;
  };
  std::vector<Blob> blobs;
  for (int i = 0; i < 5; ++i) {
    const glm::dvec3 centre(place(random), place(random), place(random));
    blobs.push_back({centre, size(random), height(random)});
  }
  return test::ct_of(test::skewed_grid(60), [&](const glm::dvec3& p) {
    double hu = -1000;
    for (const Blob& blob : blobs) {
      const double away = glm::distance(p, blob.centre) / blob.sigma_mm;
      hu += blob.hu * std::exp(-away * away / 2);
    }
    return std::min(hu, 3000.0);
  });
}

TransferFunction random_function(std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1), hu(-950, 2000), step(20, 500);
  TransferFunction function;
  double at = hu(random) / 2 - 400;
  for (int i = 0; i < 5; ++i, at += step(random)) {
    const glm::dvec3 colour(share(random), share(random), share(random));
    function.points.push_back({std::clamp(at, -1000.0, 3000.0), colour, i % 2 ? 0.3 * share(random) : 0.0});
  }
  return function;
}

OrbitCamera random_camera(std::mt19937& random) {
  std::uniform_real_distribution<double> yaw(-180, 180), pitch(-89, 89), distance(220, 500);
  OrbitCamera camera;
  camera.yaw_deg = yaw(random);
  camera.pitch_deg = pitch(random);
  camera.distance_mm = distance(random);
  return camera;
}

int greatest_difference(const Image<Rgba8>& a, const Image<Rgba8>& b) {
  int greatest = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      greatest = std::max(greatest, std::abs(int(a.pixels[i][c]) - int(b.pixels[i][c])));
  return greatest;
}

Image<Rgba8> reference_of(const CtReference& reference, int width, int height) {
  Image<Rgba8> image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::dvec3 colour = glm::clamp(reference.colour(x + 0.5, y + 0.5), 0.0, 1.0);
      for (int c = 0; c < 3; ++c) image.at(x, y)[std::size_t(c)] = std::uint8_t(std::lround(255 * colour[c]));
      image.at(x, y)[3] = 255;
    }
  return image;
}

}  // namespace

// The shader stops at 0.996 of full opacity, which leaves out up to one level; rounding to 8 bits and single precision
// take the rest.
TEST_CASE("the CT is drawn as by the reference") {
  std::mt19937 random(11);
  Scene::need_context();
  VolumeView view;
  for (int round = 0; round < 12; ++round) {
    const Volume<std::int16_t> ct = random_ct(random);
    Scene scene(ct, {}, {});
    VolumeStyle style = style_of(random_function(random));
    style.ct->shaded = round % 3 != 0;
    if (round % 4 == 3) style.ct->classification = Classification::post;
    const OrbitCamera camera = random_camera(random);
    view.forget();
    const Image<Rgba8> drawn = test::read(view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, style));
    const double step_mm = style.ct->step * scene.patient->ct_voxel_mm();
    const CtReference reference(ct, *style.ct, camera, kWidth, kHeight, step_mm);
    INFO("round " << round);
    CHECK(greatest_difference(drawn, reference_of(reference, kWidth, kHeight)) <= 3 + test::of_filter(4));
  }
}

TEST_CASE("leaping over empty space changes no picture by more than a grey level") {
  std::mt19937 random(12);
  Scene::need_context();
  VolumeView view;
  long different_from_background = 0;
  for (int round = 0; round < 40; ++round) {
    Scene scene(random_ct(random), {}, {});
    VolumeStyle style = style_of(random_function(random));
    style.ct->jittered = round % 2;
    style.ct->step = round % 3 == 0 ? 0.37 : 0.9;
    const OrbitCamera camera = random_camera(random);
    const auto draw = [&](bool skips) {
      style.ct->skips_empty = skips;
      view.forget();
      return test::read(view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, style));
    };
    const Image<Rgba8> with = draw(true), without = draw(false);
    INFO("round " << round);
    CHECK(greatest_difference(with, without) <= 1);
    for (const Rgba8& pixel : with.pixels) different_from_background += pixel[0] > 35;
  }
  CHECK(different_from_background > 10000);
}

// A ball of 1 mm voxels has an edge of up to a voxel on each side of the chord, which changes the opacity by up to
// exp(-0.02 * chord) * 0.02 * 2 mm < 0.04.
TEST_CASE("a homogeneous ball is as opaque as its chord is long") {
  const double radius = 40, opacity_per_mm = 0.02;
  const auto ball = [&](const glm::dvec3& p) { return glm::length(p) < radius ? 500.0 : -1000.0; };
  Scene scene(test::ct_of(test::skewed_grid(50), ball), {}, {});
  VolumeStyle style =
      style_of({"", {{-301, {1, 1, 1}, 0}, {-300, {1, 1, 1}, opacity_per_mm}, {3000, {1, 1, 1}, opacity_per_mm}}});
  style.ct->shaded = false;
  VolumeView view;
  OrbitCamera camera;
  camera.distance_mm = 400;
  const Image<Rgba8> drawn = test::read(view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, style));
  const CtReference rays(test::ct_of(test::skewed_grid(2), ball), *style.ct, camera, kWidth, kHeight, 1);
  int checked = 0;
  for (int x = 0; x < kWidth; ++x) {
    const glm::dvec3 ray = rays.direction(x + 0.5, kHeight / 2 + 0.5);
    const double nearest = glm::length(rays.eye() - glm::dot(rays.eye(), ray) * ray);
    if (nearest > 0.9 * radius) continue;
    const double chord = 2 * std::sqrt(radius * radius - nearest * nearest);
    const double opacity = 1 - std::pow(1 - opacity_per_mm, chord);
    const double background = rays.background(x + 0.5, kHeight / 2 + 0.5).r;
    const double seen = (drawn.at(x, kHeight / 2)[0] / 255.0 - background) / (1 - background);
    INFO("column " << x << ", chord " << chord);
    CHECK(std::abs(seen - opacity) < 0.04);
    ++checked;
  }
  CHECK(checked > 20);
}

// Density rises along the ray by 50 HU per mm, so that a function that shows 40 HU of it shows a sheet of 0.8 mm. The
// samples are 2 mm apart.
TEST_CASE("a thin layer of a ramp is exact when pre-integrated, and missed by many post-classified samples") {
  Grid grid;
  grid.size = {41, 41, 41};
  grid.spacing = glm::dvec3(1.0);
  grid.origin = glm::dvec3(-20.0);
  const Volume<std::int16_t> ramp = test::ct_of(grid, [](const glm::dvec3& p) { return 1000 + 50 * p.y; });
  Scene scene(ramp, {}, {});
  const double opacity = 0.6;
  VolumeStyle style = style_of(
      {"", {{980, {1, 1, 1}, 0}, {981, {1, 1, 1}, opacity}, {1020, {1, 1, 1}, opacity}, {1021, {1, 1, 1}, 0}}});
  style.ct->shaded = false;
  style.ct->step = 2;
  VolumeView view;
  OrbitCamera camera;
  camera.distance_mm = 2000;
  camera.field_of_view_deg = 5;
  const CtReference rays(ramp, *style.ct, camera, 40, 40, 2);
  // In the last half voxel and the half of air beyond it, density falls from 1975 to 500 HU within 1 mm.
  const double expected = 1 - std::pow(1 - opacity, 40 / 50.0 + 40 / 1475.0);
  const auto shares_seen = [&](Classification classification) {
    style.ct->classification = classification;
    view.forget();
    const Image<Rgba8> drawn = test::read(view.render(40, 40, *scene.patient, camera, scene.plane, style));
    std::vector<double> seen;
    for (int x = 17; x < 23; ++x)
      for (int y = 17; y < 23; ++y) {
        const double background = rays.background(x + 0.5, y + 0.5).r;
        seen.push_back((drawn.at(x, y)[0] / 255.0 - background) / (1 - background));
      }
    return seen;
  };
  for (const double seen : shares_seen(Classification::pre_integrated)) CHECK(seen == Approx(expected).margin(0.01));
  for (const double seen : shares_seen(Classification::post)) CHECK(std::abs(seen - expected) > 0.1);
}

// A step is 0.5 mm. Pixels whose surface lies within half of it of the plane may show either.
TEST_CASE("from any side, plane and surface hide each other as their depths say") {
  const double radius = 35;
  const auto ball = [&](const glm::dvec3& p) { return 500.0 * (radius - glm::length(p)); };
  const Volume<std::int16_t> ct =
      test::ct_of(test::skewed_grid(50), [&](const glm::dvec3& p) { return std::clamp(ball(p), -1000.0, 1000.0); });
  Scene scene(ct, {}, {});
  scene.set_picture(110, 110, 1.0, {255, 0, 255, 255});
  VolumeStyle style = style_of(above(0));
  style.plane = true;
  VolumeView view;
  std::mt19937 random(13);
  int plane_seen = 0, surface_seen = 0;
  for (int round = 0; round < 50; ++round) {
    const OrbitCamera camera = random_camera(random);
    std::uniform_real_distribution<double> turn(-180, 180), aside(-30, 30);
    // One draw per line, because compilers evaluate the arguments of a call in different orders.
    const glm::dvec3 axis(0.4, aside(random), 9);
    const double angle = glm::radians(turn(random));
    const glm::dmat3 turned(glm::rotate(glm::dmat4(1.0), angle, glm::normalize(axis)));
    scene.plane.patient_from_probe = {turned, turned * glm::dvec3(0, -55, aside(random))};
    view.forget();
    const Image<Rgba8> drawn = test::read(view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, style));
    const CtReference reference(ct, *style.ct, camera, kWidth, kHeight, 0.05);
    const Pose probe_from_patient = scene.plane.patient_from_probe.inverse();
    for (int y = 2; y < kHeight; y += 5)
      for (int x = 2; x < kWidth; x += 5) {
        const glm::dvec3 ray = reference.direction(x + 0.5, y + 0.5);
        const glm::dvec3 eye = probe_from_patient.point(reference.eye()), along = probe_from_patient.direction(ray);
        const double t_plane = -eye.z / along.z;
        const glm::dvec3 hit = eye + t_plane * along;
        // The picture's edge is blurred over a pixel of the screen, on the plane.
        const double edge =
            2 + 1.5 * 2 * std::tan(glm::radians(15.0)) / kHeight * t_plane / std::max(std::abs(along.z), 0.25);
        const bool on_picture = t_plane > 0 && std::abs(hit.x) < 55 - edge && std::abs(hit.y - 55) < 55 - edge;
        const bool beside = t_plane < 0 || std::abs(hit.x) > 55 + edge || std::abs(hit.y - 55) > 55 + edge;
        if (!on_picture && !beside) continue;
        const double half = 0.25;
        const double surface_before = reference.layer(x + 0.5, y + 0.5, 0, t_plane - half).a;
        const double surface_up_to = reference.layer(x + 0.5, y + 0.5, 0, t_plane + half).a;
        const Rgba8& pixel = drawn.at(x, y);
        const bool magenta = pixel[0] > 150 && pixel[2] > 150 && pixel[1] < 60;
        if (on_picture && surface_up_to < 0.05) {
          CHECK(magenta);
          ++plane_seen;
        } else if (beside || surface_before > 0.95) {
          CHECK(!magenta);
          surface_seen += surface_before > 0.95;
        }
      }
  }
  CHECK(plane_seen > 1000);
  CHECK(surface_seen > 500);
}

TEST_CASE("the scanner's table is left out, and the body is not") {
  const auto body_and_table = [](const glm::dvec3& p) {
    const bool body = glm::length(glm::dvec2(p))<30, table = p.y> 42 && p.y < 50 && std::abs(p.x) < 50;
    return body || table ? 60.0 : -1000.0;
  };
  Scene scene(test::ct_of(test::skewed_grid(60), body_and_table), {}, {});
  VolumeStyle style = style_of(above(-300, {1, 1, 1}));
  VolumeView view;
  OrbitCamera camera;
  camera.distance_mm = 500;
  camera.yaw_deg = 180;  // from behind
  const auto lit = [&](bool body_only, const glm::dvec3& at) {
    style.ct->body_only = body_only;
    view.forget();
    const Image<Rgba8> drawn = test::read(view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, style));
    const glm::dvec2 pixel = camera.project(at, kWidth, kHeight);
    return drawn.at(int(pixel.x), int(pixel.y))[0] > 60;
  };
  CHECK(lit(false, {45, 46, 0}));
  CHECK(!lit(true, {45, 46, 0}));
  CHECK(lit(true, {0, 30, 0}));
}

TEST_CASE("the graphics card measures the same distances to what is visible as the processor") {
  const auto two_balls = [](const glm::dvec3& p) {
    return glm::distance(p, {25, -20, 30}) < 9 ? 700.0 : glm::length(p) < 12 ? 60.0 : -1000.0;
  };
  Scene scene(test::ct_of(test::skewed_grid(70), two_balls), {}, {});
  ClassifiedCt by_processor({}, RayShader::fragment), by_card({}, RayShader::compute);
  const auto distances_of = [&](ClassifiedCt& classified, const TransferFunction& function) {
    classified.update(*scene.patient, *style_of(function).ct);
    const gl::Texture& distances = classified.distances();
    std::vector<std::uint8_t> values(std::size_t(distances.width() * distances.height() * distances.depth()));
    distances.read(GL_RED_INTEGER, GL_UNSIGNED_BYTE, values.data(), values.size());
    return values;
  };
  for (const double from : {-300.0, 300.0, 1000.0}) {  // both balls, one, and nothing at all
    const std::vector<std::uint8_t> of_processor = distances_of(by_processor, above(from));
    CHECK(distances_of(by_card, above(from)) == of_processor);
    CHECK((std::ranges::count(of_processor, 0) > 0) == (from < 700));
  }
}

TEST_CASE("an edit of the transfer function is drawn at once, and nothing is drawn while nothing changes") {
  Scene scene(
      test::ct_of(test::skewed_grid(40), [](const glm::dvec3& p) { return glm::length(p) < 30 ? 60.0 : -1000.0; }), {},
      {});
  VolumeView view;
  OrbitCamera camera;
  camera.distance_mm = 400;
  VolumeStyle style = style_of(above(-300, {1, 0, 0}));
  const auto middle = [&] {
    return test::read(view.render(kWidth, kHeight, *scene.patient, camera, scene.plane, style))
        .at(kWidth / 2, kHeight / 2);
  };
  CHECK(middle()[0] > 2 * middle()[1]);
  const long renders = view.renders();
  middle();
  CHECK(view.renders() == renders);
  style.ct->function = above(-300, {0, 1, 0});
  CHECK(middle()[1] > 2 * middle()[0]);
  style.ct->function = above(200);
  CHECK(middle()[1] < 40);
}
