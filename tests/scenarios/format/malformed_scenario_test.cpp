#include <catch2/catch.hpp>

#include <algorithm>

#include "scenarios/scenario.h"
#include "sim/core/hash.h"
#include "sim/files/files.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

/// A scenario with a step of every kind and all that may stand around them.
const char* const kEverything = R"(
format = 2
title = "Everything"
case = "abdomen"
time_limit_s = 300
difficulty = "hard"
order = "fixed"

[[variant]]
name = "right"
phantom = { gallstone = true }
words = { side = "right" }

[[variant]]
name = "left"
words = { side = "left" }

[[step]]
kind = "set_knobs"
title = "Knobs"
instruction = "Set them."
counts = false
depth_mm = [90, 120]
probe = "linear"

[[step]]
kind = "sweep"
title = "Sweep"
instruction = "Through the ${side} one."
organ = ["ball"]
keep = ["centre"]
coverage_percent = 80

[[step.criterion]]
metric = "coverage_percent"
full = 80
zero = 10

[[step.hint]]
text = "Slower."
cost = [0, 1, 2]

[step.next]
good = "measuring"
poor = "end"

[[step]]
kind = "measure"
name = "measuring"
title = "Measure"
instruction = "Its width."
view = "ball"
tool = "distance"
walls = "outer to outer"

[[step.target]]
structures = ["ball"]
through = "centre"
along = "lateral"

[[step.criterion]]
metric = "measurement_error_mm"
full = 3
zero = 9

[[step]]
kind = "mark_point"
title = "Point"
instruction = "At its top."
landmark = "top"

[[step]]
kind = "label_structures"
title = "Name"
instruction = "Both."
structures = ["ball", "rib"]

[[step]]
kind = "question"
title = "Question"
instruction = "Is there a ball?"
choices = ["yes", "no"]
finding = ["ball"]
if_present = "yes"
if_absent = "no"

[[step]]
kind = "free_scan"
title = "Free"
instruction = "As you like."
)";

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

std::string refusal(const std::string& text) {
  try {
    parse_scenario(text, "exam.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string misfit(const std::string& text) {
  try {
    check_against_case(parse_scenario(text, "exam.toml"), tiny_case());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

struct Row {
  const char* from;
  const char* to;
  std::vector<const char*> words;
};

void check_rows(const std::vector<Row>& rows, std::string (*message_of)(const std::string&)) {
  for (const Row& row : rows) {
    const std::string message = message_of(with(kEverything, row.from, row.to));
    INFO(row.from << " -> " << row.to << "\n" << message);
    CHECK(message.find("exam.toml: ") == 0);
    for (const char* word : row.words) {
      INFO(word);
      CHECK(message.find(word) != std::string::npos);
    }
  }
}

}  // namespace

TEST_CASE("a scenario with every kind of step is read and fits its case") {
  CHECK(refusal(kEverything) == "");
  CHECK(misfit(kEverything) == "");
}

TEST_CASE("what is wrong in a step of any kind is said in words") {
  check_rows(
      {
          {"format = 2", "format = 3", {"line 2, column 10", "format 3", "formats 1 and 2"}},
          {"difficulty = \"hard\"", "difficulty = \"herd\"", {"line 6", "'herd'", "did you mean 'hard'?"}},
          {"order = \"fixed\"", "order = 3", {"'order' is not a text"}},
          {"order = \"fixed\"", "order = \"free\"", {"step 2", "the order is free"}},
          {"name = \"left\"", "name = \"right\"", {"variant 2", "the name 'right' is taken"}},
          {"words = { side = \"left\" }", "words = { sid = \"left\" }", {"line 29", "'${side}'", "'left'", "'sid'"}},
          {"words = { side = \"left\" }", "words = 3", {"'words' is not a table; write [variant.words]"}},
          {"words = { side = \"left\" }",
           "wirds = { side = \"left\" }",
           {"the key 'wirds' is unknown here", "'words'"}},
          {"phantom = { gallstone = true }", "phantom = { gallstone = [1] }", {"not a single value"}},
          {"phantom = { gallstone = true }", "case = \"tiny\"\nphantom = { gallstone = true }", {"'tiny'"}},
          {"depth_mm = [90, 120]\nprobe = \"linear\"", "", {"step 1", "no setting is asked for"}},
          {"depth_mm = [90, 120]", "depth_mm = [120, 90]", {"step 1", "larger number; write [90, 120]"}},
          {"depth_mm = [90, 120]", "depth_mm = 100", {"not a range", "from 1 to 1000"}},
          {"depth_mm = [90, 120]", "depth_mm = [90, 120]\nview = \"ball\"", {"the key 'view' is unknown here"}},
          {"probe = \"linear\"", "probe = \"linaer\"", {"'linaer'", "did you mean 'linear'?"}},
          {"organ = [\"ball\"]", "organ = []", {"step 2", "'organ' is empty"}},
          {"organ = [\"ball\"]", "organ = \"ball\"", {"not a list", "organ = [\"...\"]"}},
          {"organ = [\"ball\"]", "organ = [7]", {"not a text"}},
          {"coverage_percent = 80", "coverage_percent = 0", {"1 to 100"}},
          {"metric = \"coverage_percent\"",
           "metric = \"longest_hold_s\"",
           {"step 2: a step of the kind sweep does not measure longest_hold_s", "coverage_percent"}},
          {"metric = \"coverage_percent\"", "metric = \"target_in_view_percent\"", {"does not measure"}},
          {"cost = [0, 1, 2]",
           "cost = [0, 1]",
           {"hint 1 of step 2", "'cost' has 2 numbers; write 3 numbers from 0 to 1000"}},
          {"cost = [0, 1, 2]", "cost = -1", {"'cost' is -1"}},
          {"cost = [0, 1, 2]", "", {"the key 'cost' is missing"}},
          {"good = \"measuring\"", "good = \"mesuring\"", {"'mesuring'", "did you mean 'measuring'?"}},
          {"name = \"measuring\"", "name = \"end\"", {"'end' is taken"}},
          {"tool = \"distance\"", "tool = \"distanz\"", {"step 3", "did you mean 'distance'?"}},
          {"tool = \"distance\"", "tool = \"ratio\"", {"too few targets", "add two"}},
          {"walls = \"outer to outer\"", "", {"the key 'walls' is missing"}},
          {"along = \"lateral\"", "along = \"sideways\"", {"target 1 of step 3", "'sideways'"}},
          {"landmark = \"top\"", "", {"step 4", "nothing to mark is named"}},
          {"landmark = \"top\"", "landmark = \"top\"\nstructures = [\"ball\"]", {"both a landmark and structures"}},
          {"structures = [\"ball\", \"rib\"]", "structures = [\"rib\", \"rib\"]", {"step 5", "twice"}},
          {"choices = [\"yes\", \"no\"]", "choices = [\"yes\"]", {"step 6", "only one choice"}},
          {"if_absent = \"no\"", "if_absent = \"non\"", {"not among the choices", "did you mean 'no'?"}},
          {"if_absent = \"no\"",
           "if_absent = \"yes\"",
           {"step 6", "the right answer is the same with the finding as without"}},
          {"choices = [\"yes\", \"no\"]", "choices = [\"yes\", \"no\", \"yes\"]", {"step 6", "'yes' is offered twice"}},
          {"if_absent = \"no\"", "", {"the key 'if_absent' is missing"}},
          {"finding = [\"ball\"]", "", {"the key 'right' is missing", "the key 'if_present' is unknown here"}},
          {"instruction = \"As you like.\"",
           "instruction = \"As you like.\"\ncounts = false",
           {"step 7", "warm-up is behind a step that counts"}},
      },
      refusal);
}

TEST_CASE("a step whose kind is wrong has its wrong keys reported too, and no key that some kind takes") {
  const std::string everything = kEverything, key = "kind = \"";
  for (std::size_t at = everything.find(key); at != std::string::npos; at = everything.find(key, at + 1)) {
    std::string text = everything;
    text.replace(at, text.find('\n', at) - at, "kind = \"no_such\"");
    CHECK(refusal(text).find("there is no kind of step 'no_such'") != std::string::npos);
    CHECK(refusal(text).find("is unknown here") == std::string::npos);
    text.insert(at, "colour = 3\n");
    CHECK(refusal(text).find("there is no kind of step 'no_such'") != std::string::npos);
    CHECK(refusal(text).find("the key 'colour' is unknown here") != std::string::npos);
  }
}

TEST_CASE("a step whose kind is misspelt is read as the kind that is probably meant") {
  std::string text = with(kEverything, "kind = \"measure\"", "kind = \"measur\"");
  text = with(text, "walls = \"outer to outer\"", "wall = \"outer to outer\"");
  text = with(text, "metric = \"measurement_error_mm\"\nfull = 3", "metric = \"coverage_percent\"\nfull = 3");
  const std::string said = refusal(text);
  CHECK(said.find("there is no kind of step 'measur'; did you mean 'measure'?") != std::string::npos);
  CHECK(said.find("the key 'wall' is unknown here") != std::string::npos);
  CHECK(said.find("a step of the kind measure does not measure coverage_percent") != std::string::npos);
}

TEST_CASE("names in steps of any kind are checked against the case") {
  check_rows(
      {
          {"organ = [\"ball\"]", "organ = [\"bal\"]", {"line 30, column 9", "'bal'", "did you mean 'ball'?"}},
          {"keep = [\"centre\"]", "keep = [\"center\"]", {"step 2", "did you mean 'centre'?"}},
          {"view = \"ball\"", "view = \"bal\"", {"step 3", "did you mean 'ball'?"}},
          {"through = \"centre\"", "through = \"middle\"", {"step 3", "'middle'"}},
          {"landmark = \"top\"", "landmark = \"tip\"", {"step 4", "did you mean 'top'?"}},
          {"structures = [\"ball\", \"rib\"]", "structures = [\"ball\", \"ribs\"]", {"step 5", "did you mean 'rib'?"}},
          {"finding = [\"ball\"]", "finding = [\"stone\"]", {"step 6", "'stone'"}},
      },
      misfit);
}

TEST_CASE("all problems of all variants come at once, each of them once") {
  std::string text = with(kEverything, "walls = \"outer to outer\"\n", "");
  text = with(text, "probe = \"linear\"", "probe = \"lin\"");
  text = with(text, "words = { side = \"left\" }", "words = { sid = \"left\" }");
  try {
    parse_scenario(text, "exam.toml");
    FAIL("it was read");
  } catch (const ScenarioError& error) {
    INFO(error.what());
    CHECK(error.problems().size() == 3);
  }
}

TEST_CASE("whatever becomes of a shipped scenario, it is read or refused in words") {
  int files = 0, refused = 0;
  std::vector<std::string> texts{kEverything};
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(INSONATE_ASSETS_FOLDER) / "scenarios"))
    texts.push_back(read_file(entry.path()));
  std::sort(texts.begin(), texts.end());  // a folder's order is nobody's to know
  const std::vector<std::string> scraps{"\"",   "[[step]]\n",    "[",
                                        "]",    " = ",           "1e999",
                                        "-1",   "nan",           "${side}",
                                        "\n",   "true",          "{ a = 1 }",
                                        "\xff", "[[variant]]\n", "kind = \"sweep\"\n"};
  for (std::uint32_t f = 0; f < texts.size(); ++f) {
    ++files;
    for (std::uint32_t i = 0; i < 120; ++i) {
      std::string text = texts[f];
      for (std::uint32_t k = 0; k < 1 + hash(f, i, 1, 0) % 4; ++k) {
        const std::size_t at = hash(f, i, 2, k) % text.size(), length = hash(f, i, 3, k) % 40;
        switch (hash(f, i, 4, k) % 4) {
          case 0:
            text[at] = char(hash(f, i, 5, k));
            break;
          case 1:
            text.erase(at, length);
            break;
          case 2:
            text.insert(at, text.substr(hash(f, i, 6, k) % text.size(), length));
            break;
          default:
            text.insert(at, scraps[hash(f, i, 7, k) % scraps.size()]);
        }
        if (text.empty()) text = " ";
      }
      try {
        check_against_case(parse_scenario(text, "exam.toml"), tiny_case());
      } catch (const InputError& error) {
        ++refused;
        CHECK(std::string(error.what()).rfind("exam.toml: ", 0) == 0);
      }
    }
  }
  CHECK(files > 1);
  CHECK(refused > 60 * files);
}

TEST_CASE("a key of too many parts is a problem in its line, and does not overflow the stack") {
  std::string key = "a";
  for (int i = 0; i < 500'000; ++i) key += ".a";
  try {
    parse_scenario("format = 2\n" + key + " = 1\n", "deep.toml");
    FAIL("it was taken");
  } catch (const ScenarioError& error) {
    REQUIRE(error.problems().size() == 1);
    CHECK(error.problems()[0].place.line == 2);
  }
}

TEST_CASE("a refusal lists a hundred problems at most, each on a line that is safe to show") {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "key" + std::to_string(i) + " = 1\n";
  try {
    parse_scenario(text + "\"\\u001b[2J\\n\" = 1\n", "wrong.toml");
    FAIL("it was taken");
  } catch (const ScenarioError& error) {
    const std::string said = error.what();
    CHECK(error.problems().size() > 1000);
    CHECK(std::count(said.begin(), said.end(), '\n') == 101);
    CHECK(said.ends_with("\n  and so on."));
  }
  CHECK_THROWS_WITH(parse_scenario("\"\\u001b[2J\\n\" = 1\n", "wrong.toml"),
                    Catch::Contains("[2J") && !Catch::Contains("\x1b") && !Catch::Contains("J\n"));
}
