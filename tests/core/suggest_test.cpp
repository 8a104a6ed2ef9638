#include "sim/core/suggest.h"

#include <catch2/catch.hpp>

using namespace insonate;

TEST_CASE("an unknown name is answered with the nearest known one, or with all of them") {
  CHECK(suggest("depht_mm", {"width_mm", "depth_mm"}) == "did you mean 'depth_mm'?");
  CHECK(suggest("dephts", {"depth", "depths"}) == "did you mean 'depths'?");  // both are two slips away
  CHECK(suggest("colour", {"width", "depth"}) == "use one of 'width', 'depth'");
  CHECK(suggest("colour", {"width"}) == "use 'width'");
  CHECK(suggest("colour", {}) == "remove it");
  CHECK(similar_name("widh", {"depth", "with"}) == "with");
  CHECK_FALSE(similar_name("colour", {"width", "depth"}));
}
