#include "sim/files/mistake.h"

#include <catch2/catch.hpp>

using namespace insonate;

TEST_CASE("several mistakes are one error, in the order of the file and each once") {
  const std::vector<Mistake> mistakes{
      {{3, 1}, "c", "mend it"}, {{1, 5}, "b", "mend it"}, {{3, 1}, "c", "mend it"}, {{1, 2}, "a\x1b", "mend it"}};
  CHECK(input_error("lab.toml", mistakes).what() ==
        std::string("lab.toml: 3 problems; correct them:\n  line 1, column 2: a ; mend it\n"
                    "  line 1, column 5: b; mend it\n  line 3, column 1: c; mend it."));
  CHECK(input_error("lab.toml", {mistakes[0], mistakes[2]}).what() ==
        std::string("lab.toml: line 3, column 1: c; mend it."));
  CHECK(input_error("lab.toml", {{{}, "c", "mend it"}}).what() == std::string("lab.toml: c; mend it."));
}

TEST_CASE("of many mistakes a hundred are listed") {
  std::vector<Mistake> mistakes;
  for (int line = 1; line <= 101; ++line) mistakes.push_back({{line, 1}, "it is wrong", "mend it"});
  const std::string text = input_error("lab.toml", mistakes).what();
  CHECK(text.starts_with("lab.toml: 101 problems"));
  CHECK(text.ends_with("line 100, column 1: it is wrong; mend it\n  and so on."));
}
