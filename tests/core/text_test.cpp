#include "sim/core/text.h"

#include <catch2/catch.hpp>

using namespace insonate;

TEST_CASE("unwrapping joins the lines of a paragraph and keeps paragraphs apart") {
  CHECK(unwrapped("\nA man of 70.\nFollow the aorta\r\nto its end.\n\n \nMeasure it.\n") ==
        "A man of 70. Follow the aorta to its end.\n\nMeasure it.");
  CHECK(unwrapped("one line") == "one line");
  CHECK(unwrapped(" \n\n").empty());
}
