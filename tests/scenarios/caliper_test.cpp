#include "scenarios/caliper.h"

#include <catch2/catch.hpp>

using namespace insonate;

TEST_CASE("what calipers measure is written as machines write it") {
  CHECK(value_text({ActionKind::caliper, {1, 0, 0, 3, 4}}) == "5.0 mm");
  CHECK(value_text({ActionKind::caliper, {1, 0, 0, 0, 123.44}}) == "12.34 cm");
  CHECK(value_text({ActionKind::ellipse, {1, -20, 0, 20, 0, 10}}) == "6.28 cm\u00b2");  // pi * 2 * 1
  CHECK(volume_text(ellipsoid_volume_ml(100, 80, 60)) == "251 ml");                     // pi / 6 * 480
}

TEST_CASE("a slanted ellipse keeps its middle and its other axis where they belong") {
  const Action ellipse{ActionKind::ellipse, {1, 0, 0, 30, 40, 5}};  // its first axis is 50 mm long, along (3, 4) / 5
  const std::vector<glm::dvec2> ends = handles(ellipse);
  REQUIRE(ends.size() == 4);
  CHECK(ends[2].x == Approx(15 + 4));
  CHECK(ends[2].y == Approx(20 - 3));
  CHECK(ends[3].x == Approx(15 - 4));
  CHECK(ends[3].y == Approx(20 + 3));
  // 10 mm beside the middle, and 7 mm along the first axis, which does not matter.
  const Action wider = with_handle_at(ellipse, 3, {15 - 8 + 4.2, 20 + 6 + 5.6});
  CHECK(wider.numbers[5] == Approx(10));
  for (const glm::dvec2& p : outline(ellipse, 16)) {
    const glm::dvec2 off = p - glm::dvec2(15, 20);
    const double along = (3 * off.x + 4 * off.y) / 5, across = (4 * off.x - 3 * off.y) / 5;
    CHECK(along * along / 625 + across * across / 25 == Approx(1));
  }
  CHECK(handles({ActionKind::ellipse, {1, 7, 7, 7, 7, 0}}).size() ==
        4);  // of no length it has a direction all the same
}
