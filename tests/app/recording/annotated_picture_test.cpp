#include "app/recording/annotated_picture.h"

#include <catch2/catch.hpp>

#include "app/session/plane_on_screen.h"

using namespace insonate;

namespace {

constexpr Rgba8 kEcho{90, 90, 90, 255};

/// 200 x 240 pixels of 0.5 mm, whose middle column is the central beam.
struct Marked {
  ImageGeometry geometry{200, 240, 0.5, {-49.75, 0.25}};
  Image<Rgba8> picture{200, 240, kEcho};

  void draw(const std::vector<Action>& placed) { draw_annotations(picture, geometry, placed); }
  const Rgba8& at(const glm::dvec2& plane_mm) const {
    const glm::dvec2 p = PlaneOnScreen({0, 0}, {200, 240}, geometry).screen(plane_mm);
    return picture.at(int(p.x), int(p.y));
  }
  bool is_bright(const glm::dvec2& plane_mm) const { return at(plane_mm)[0] > 200; }
};

}  // namespace

TEST_CASE("a caliper is drawn at its ends with the marker's side on the left, and dotted between them") {
  Marked marked;
  marked.draw({{ActionKind::caliper, {1, 30, 40, -10, 40}}});
  CHECK(marked.is_bright({30, 40}));
  CHECK(marked.is_bright({-10, 40}));
  CHECK_FALSE(marked.is_bright({-30, 40}));
  CHECK(marked.picture.at(99 - 60, 80)[0] > 200);  // 30 mm to the marker's side: 60 pixels left of the middle
  int bright = 0, dark = 0;
  for (double x = -5; x < 25; x += 0.5) (marked.is_bright({x, 40}) ? bright : dark)++;
  CHECK(bright > 5);
  CHECK(dark > bright);
  CHECK(marked.at({10, 60}) == kEcho);
}

TEST_CASE("ellipses have their outline, points and names a cross, and what lies outside the picture is left out") {
  Marked marked;
  marked.draw({{ActionKind::ellipse, {1, -20, 60, 20, 60, 10}},
               {ActionKind::point, {-40, 20}},
               {ActionKind::label, {40, 20}, "liver"},
               {ActionKind::caliper, {2, -400, -400, 400, 900}}});
  for (const glm::dvec2& at : {glm::dvec2{-20, 60}, {20, 60}, {0, 50}, {0, 70}, {-40, 20}, {40, 20}})
    CHECK(marked.is_bright(at));
  CHECK(marked.at({-10, 60}) == kEcho);
}
