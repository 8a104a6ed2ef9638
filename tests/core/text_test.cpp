#include "sim/core/text.h"

#include <catch2/catch.hpp>

using namespace insonate;

TEST_CASE("unwrapping joins the lines of a paragraph and keeps paragraphs apart") {
  CHECK(unwrapped("\nA man of 70.\nFollow the aorta\r\nto its end.\n\n \nMeasure it.\n") ==
        "A man of 70. Follow the aorta to its end.\n\nMeasure it.");
  CHECK(unwrapped("one line") == "one line");
  CHECK(unwrapped(" \n\n").empty());
}

TEST_CASE("a format is filled in, however long the text becomes") {
  CHECK(formatted("%d of %.2f %s", 3, 0.125, "mm") == "3 of 0.12 mm");
  CHECK(formatted("plain").size() == 5);
  const std::string longest(5000, 'x');
  CHECK(formatted("<%s>", longest.c_str()) == "<" + longest + ">");
}

TEST_CASE("a word of a command can be copied into a shell") {
  CHECK(shell_word("/data/out-1/results.db") == "/data/out-1/results.db");
  CHECK(shell_word("/data/Frau Müller's/r.db") == "'/data/Frau Müller'\\''s/r.db'");
  CHECK(shell_word("") == "''");
}

TEST_CASE("a number in a sentence has the digits that it needs") {
  CHECK(exact_text(100000) == "100000");
  CHECK(exact_text(4294967295.0) == "4294967295");
  CHECK(exact_text(0.1) == "0.1");
  CHECK(exact_text(-0.001) == "-0.001");
  CHECK(exact_text(1e300) == "1e+300");
}
