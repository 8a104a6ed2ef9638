#include <catch2/catch.hpp>

#include <algorithm>

#include "sim/view/axis_slice_view.h"
#include "tests/view/test_patient.h"

using namespace insonate;
using test::Scene;
using view::AxisSlice;
using view::AxisSliceView;
using view::CtStyle;
using view::SliceAxis;

namespace {

constexpr std::array kAxes{SliceAxis::axial, SliceAxis::coronal, SliceAxis::sagittal};

/// Returns the place of the brightest pixels' centre of mass, as AxisSlice::pixel() counts.
glm::dvec2 brightest(const Image<Rgba8>& image) {
  glm::dvec2 sum(0);
  double weight = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double bright = std::max(0.0, image.at(x, y)[0] - 40.0);
      sum += bright * glm::dvec2(x + 0.5, y + 0.5);
      weight += bright;
    }
  return sum / weight;
}

}  // namespace

// The grid is rotated and mirrored, and its voxels are not cubes, so a view that ignores any of that puts the ball
// elsewhere. Half a pixel: the ball's edge has steps of voxels.
TEST_CASE("axis slices show a marked place of the patient where they say it is") {
  const glm::dvec3 place(22, -31, 14);
  Scene scene(
      test::ct_of(test::skewed_grid(80), [&](const auto& p) { return glm::distance(p, place) < 8 ? 900.0 : 0.0; }), {},
      {});
  CtStyle style;
  style.window_hu = 800;
  style.level_hu = 400;
  for (const SliceAxis axis : kAxes) {
    CAPTURE(int(axis));
    AxisSliceView view;
    const AxisSlice slice = AxisSlice::fitting(axis, scene.patient->grid(), place, 260, 180);
    const Image<Rgba8> image = test::read(view.render(*scene.patient, slice, style));
    REQUIRE(image.width == 260);
    REQUIRE(image.height == 180);
    CHECK(glm::distance(brightest(image), slice.pixel(place)) < 0.5);
    const AxisSlice elsewhere = AxisSlice::fitting(axis, scene.patient->grid(), place + 20.0, 260, 180);
    const Image<Rgba8> without = test::read(view.render(*scene.patient, elsewhere, style));
    CHECK(std::none_of(without.pixels.begin(), without.pixels.end(), [](const Rgba8& p) { return p[0] > 40; }));
  }
}

// One grey level: voxels hold whole HU, of which this window has 1.2 per level, and rounding to a level adds a half.
TEST_CASE("axis slices show the density in window and level at every pixel") {
  const auto hu_at = [](const glm::dvec3& p) { return 40 + 1.1 * p.x - 0.7 * p.y + 1.6 * p.z; };
  const Grid grid = test::skewed_grid(80);
  Scene scene(test::ct_of(grid, hu_at), {}, {});
  CtStyle style;
  style.window_hu = 300;
  for (const SliceAxis axis : kAxes) {
    CAPTURE(int(axis));
    AxisSliceView view;
    const AxisSlice slice = AxisSlice::fitting(axis, grid, {10, -20, 5}, 200, 160);
    const Image<Rgba8> image = test::read(view.render(*scene.patient, slice, style));
    double worst = 0;
    int inside = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const glm::dvec3 p = slice.patient_mm(glm::dvec2(x, y) + 0.5), index = grid.index_from_patient(p);
        if (glm::any(glm::lessThan(index, glm::dvec3(0))) ||
            glm::any(glm::greaterThan(index, glm::dvec3(grid.size - 1))))
          continue;
        ++inside;
        const double expected = 255 * std::clamp((hu_at(p) - style.level_hu) / style.window_hu + 0.5, 0.0, 1.0);
        worst = std::max(worst, std::abs(image.at(x, y)[0] - expected));
      }
    CHECK(inside > 5000);
    CHECK(worst <= 1.0 + test::of_filter(0.25));
  }
}

TEST_CASE("an axis slice outlines labels in their organs' colours, and only those that are asked for") {
  Volume<std::uint8_t> labels{test::skewed_grid(60), {}};
  view::OrganColours colours{};
  colours[9] = {{0.1f, 0.7f, 0.2f}, 0.5f};
  for (const auto in : test::ct_of(labels.grid, [](const auto& p) { return glm::length(p) < 25; }).voxels)
    labels.voxels.push_back(in ? 9 : 0);
  Scene scene(test::ct_of(labels.grid, [](const auto&) { return 0.0; }), labels, colours);
  AxisSliceView view;
  const AxisSlice slice = AxisSlice::fitting(SliceAxis::coronal, labels.grid, {}, 240, 200);
  CtStyle style;
  const Image<Rgba8> plain = test::read(view.render(*scene.patient, slice, style));
  style.outlined = {8};
  CHECK(test::read(view.render(*scene.patient, slice, style)).pixels == plain.pixels);
  style.outlined = {9};
  const Image<Rgba8> outlined = test::read(view.render(*scene.patient, slice, style));
  int on_edge = 0, off_edge = 0;
  for (int y = 0; y < slice.height; ++y)
    for (int x = 0; x < slice.width; ++x) {
      if (outlined.at(x, y) == plain.at(x, y)) continue;
      const double from_middle = glm::length(slice.patient_mm(glm::dvec2(x, y) + 0.5));
      ++(std::abs(from_middle - 25) < 1.4 + 2 * slice.mm_per_pixel ? on_edge : off_edge);
      CHECK(outlined.at(x, y)[1] > outlined.at(x, y)[0]);
    }
  CHECK(off_edge == 0);
  CHECK(on_edge > 100);
}

TEST_CASE("an axis slice is drawn anew only when something changed") {
  Scene scene(test::ct_of(test::skewed_grid(40), [](const auto& p) { return p.x; }), {}, {});
  AxisSliceView view;
  AxisSlice slice = AxisSlice::fitting(SliceAxis::axial, scene.patient->grid(), {}, 60, 40);
  CtStyle style;
  const auto renders_after = [&] {
    view.render(*scene.patient, slice, style);
    return view.renders();
  };
  CHECK(renders_after() == 1);
  CHECK(renders_after() == 1);
  slice.middle.z += 1;
  CHECK(renders_after() == 2);
  style.level_hu += 10;
  CHECK(renders_after() == 3);
  style.outlined = {3};
  CHECK(renders_after() == 4);
  CHECK(renders_after() == 4);
  view.forget();
  CHECK(renders_after() == 5);
}
