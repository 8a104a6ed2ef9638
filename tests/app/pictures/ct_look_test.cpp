#include "app/pictures/ct_look.h"

#include <catch2/catch.hpp>

using namespace insonate;

TEST_CASE("a drag across widens the window, and one upwards raises the level") {
  const WindowLevel soft{400, 40};
  CHECK(dragged(soft, {0, 0}) == soft);
  CHECK(dragged(soft, {30, 0}) == WindowLevel{430, 40});
  CHECK(dragged(soft, {-30, 0}) == WindowLevel{370, 40});
  CHECK(dragged(soft, {0, -25}) == WindowLevel{400, 65});
  CHECK(dragged(soft, {10.4, 25.4}) == WindowLevel{410, 15});
}

TEST_CASE("wide windows change faster, and narrow ones by single units") {
  CHECK(dragged({2000, 400}, {40, 40}) == WindowLevel{2200, 200});
  CHECK(dragged({80, 40}, {-7, 0}) == WindowLevel{73, 40});
}

TEST_CASE("window and level stay within what a CT has") {
  CHECK(dragged({150, 60}, {-1000, 0}).window_hu == WindowLevel::kMinWindow);
  CHECK(dragged({3000, 60}, {10000, 10000}) == WindowLevel{WindowLevel::kMaxWindow, WindowLevel::kMinLevel});
  CHECK(dragged({3000, 60}, {0, -10000}).level_hu == WindowLevel::kMaxLevel);
}
