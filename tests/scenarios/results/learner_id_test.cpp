#include "scenarios/results/learner_id.h"

#include <catch2/catch.hpp>

using namespace insonate;

TEST_CASE("codes pass as a learner's id, names and addresses as people write them do not") {
  for (const char* id : {"7", "L-2026_014.b", kNobodyInParticular}) CHECK(why_no_learner_id(id).empty());
  CHECK(why_no_learner_id(std::string(64, 'a')).empty());
  for (const char* id : {"", "Ada Lovelace", "ada@lab.example", "M\u00fcller", "a,b", "a\n", "../7", "a/b"})
    CHECK_FALSE(why_no_learner_id(id).empty());
  CHECK(why_no_learner_id(std::string(65, 'a')).find("65") != std::string::npos);
  CHECK(why_no_learner_id(std::string("a\0b", 3)).find("'a?b'") != std::string::npos);
}
