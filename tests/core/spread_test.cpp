#include "sim/core/spread.h"

#include <catch2/catch.hpp>

using namespace insonate;

TEST_CASE("the spread of values is their median and quartiles, which lie between the values that enclose them") {
  const Spread one = spread_of({7});
  CHECK(one.first_quartile == 7);
  CHECK(one.median == 7);
  CHECK(one.third_quartile == 7);
  const Spread odd = spread_of({9, 1, 5, 3, 7});
  CHECK(odd.first_quartile == 3);
  CHECK(odd.median == 5);
  CHECK(odd.third_quartile == 7);
  const Spread even = spread_of({4, 1, 2, 3});  // R: quantile(1:4), type 7
  CHECK(even.first_quartile == 1.75);
  CHECK(even.median == 2.5);
  CHECK(even.third_quartile == 3.25);
  CHECK(spread_of({}).median == 0);
}
