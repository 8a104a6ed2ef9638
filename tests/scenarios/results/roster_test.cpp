#include "scenarios/results/roster.h"

#include <catch2/catch.hpp>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "tests/scenarios/results/made_attempt.h"

using namespace insonate;

namespace {

using Ids = std::vector<std::string>;

/// What reading `text` under that name is refused with; empty when it is not.
std::string refusal(const ResultsFolder& folder, const char* name, const std::string& text) {
  write_file(folder / name, text);
  try {
    read_roster(folder / name);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("a roster is read from CSV as spreadsheets write it, and from TOML") {
  const ResultsFolder folder;
  write_file(folder / "a.csv", "\xef\xbb\xbflearner\r\nL-01\r\n\r\n \"L-02\" \r\n7");
  CHECK(read_roster(folder / "a.csv") == Ids{"L-01", "L-02", "7"});
  write_file(folder / "a.toml", "format = 1\nlearners = [\"L-01\", \"7\"]\n");
  CHECK(read_roster(folder / "a.toml") == Ids{"L-01", "7"});
}

TEST_CASE("a roster with anything but ids is refused with the line") {
  const ResultsFolder folder;
  const auto refused = [&](const char* name, const std::string& text, const std::string& words) {
    const std::string said = refusal(folder, name, text);
    INFO(said);
    CHECK(said.find(words) != std::string::npos);
    CHECK(said.find('\n') == std::string::npos);
  };
  refused("r.csv", "L-01\nL-02\n", "line 1");
  refused("r.csv", "learner,name\nL-01,Ada\n", "line 1");
  refused("r.csv", "learner\nL-01,Ada\n", "line 2");
  refused("r.csv", "learner\nL-01\n\nada@lab.example\n", "line 4");
  refused("r.csv", "learner\nL-01\nL-02\nL-01\n", "line 4: 'L-01' stands at line 2 already");
  refused("r.csv", "learner\n", "lists no learners");
  refused("r.csv", std::string("learner\nL\0\x01\n", 12), "line 2");
  std::string many = "learner\n";
  for (std::size_t i = 0; i <= kMaxLearners; ++i) many += std::to_string(i) + "\n";
  refused("r.csv", many, "above the limit of 100000");
  refused("r.toml", "format = 2\nlearners = [\"a\"]\n", "format");
  refused("r.toml", "format = 1\nlearner = [\"a\"]\n", "learners");
  refused("r.toml", "format = 1\nlearners = [\"a\", \"b c\"]\n", "number 2");
  refused("r.toml", "format = 1\nlearners = [1]\n", "learners");
  refused("r.toml", "format = 1\nlearners = [", "line");
  CHECK_THROWS_AS(read_roster(folder / "none.csv"), InputError);
}
