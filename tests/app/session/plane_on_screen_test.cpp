#include "app/session/plane_on_screen.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

using namespace insonate;

TEST_CASE("a place on the screen is the millimetre that is drawn there, and back") {
  // A picture of 320 x 200 pixels of 0.5 mm whose first pixel's centre lies at (-80, -3), shown at (40, 100) in an area
  // that is three times as wide, and not quite three times as high.
  const ImageGeometry geometry{320, 200, 0.5, {-80, -3}};
  const PlaneOnScreen plane({40, 100}, {960, 597}, geometry);

  // By hand: the first pixel fills the area's right end, as the marker's side is on the left, and its centre lies half
  // a pixel's 3 and 2.985 from the edges.
  CHECK(plane.screen({-80, -3}).x == Approx(1000 - 1.5));
  CHECK(plane.screen({-80, -3}).y == Approx(100 + 597 / 400.0));
  // The last one's centre lies at (79.5, 96.5).
  CHECK(plane.screen({79.5, 96.5}).x == Approx(40 + 1.5));
  CHECK(plane.screen({79.5, 96.5}).y == Approx(697 - 597 / 400.0));
  // The area's corners are the outer edges of pixels.
  CHECK(plane.plane_mm({1000, 100}).x == Approx(-80.25));
  CHECK(plane.plane_mm({40, 697}).y == Approx(96.75));
  CHECK(plane.pixels_per_mm() == Approx(597 / 100.0));

  for (const glm::dvec2& mm : {glm::dvec2(0, 0), glm::dvec2(-33.3, 71.25), glm::dvec2(60, -2)})
    CHECK(glm::distance(plane.plane_mm(plane.screen(mm)), mm) < 1e-12);  // rounding of doubles of this size
}

TEST_CASE("a measurement does not depend on how large its picture is drawn or computed") {
  // The same 100 x 60 mm of plane, computed for different pixels and shown in different areas.
  for (const int width : {250, 500, 1000})
    for (const double area : {400.0, 901.5}) {
      const double mm = 100.0 / width;
      const ImageGeometry geometry{width, width * 6 / 10, mm, {-50 + mm / 2, mm / 2}};
      const PlaneOnScreen plane({17.25, 8.5}, {area, area * 0.6}, geometry);
      // A tenth of the area's width from end to end is a tenth of the plane's.
      const glm::dvec2 from = plane.plane_mm({17.25 + 0.3 * area, 100}), to = plane.plane_mm({17.25 + 0.4 * area, 100});
      CHECK(glm::distance(from, to) == Approx(10));
      CHECK(from.x == Approx(20));
    }
}
