#include <catch2/catch.hpp>

#include "scenarios/scenario.h"
#include "scenarios/steps/find_view.h"
#include "sim/core/hash.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// The message of a scenario that has to be refused.
std::string refusal(const std::string& text) {
  try {
    parse_scenario(text, "exam.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a scenario is read with its defaults") {
  const Scenario scenario = parse_scenario(kTinyScenario, "exam.toml");
  CHECK(scenario.title == "Find the ball");
  CHECK(scenario.case_name == "tiny");
  CHECK(scenario.briefing.empty());
  CHECK(scenario.pass_mark_percent == 60);
  REQUIRE(scenario.steps.size() == 2);
  const Step& step = scenario.steps[0];
  CHECK(step.view == "ball");
  const auto& asked = dynamic_cast<const FindView&>(*step.task);
  CHECK(asked.hold_s == 1.0);
  REQUIRE(asked.tolerance.size() == 2);
  CHECK(asked.tolerance[0].metric == Metric::plane_distance_mm);
  CHECK(asked.tolerance[0].limit == 8);
  REQUIRE(step.criteria.size() == 2);
  CHECK(step.criteria[1].metric == Metric::target_insonated_percent);
  CHECK(step.criteria[1].full == 80);
  CHECK(step.criteria[1].zero == 20);
  CHECK(step.criteria[1].critical);
  CHECK(scenario.steps[1].criteria[0].weight == 1);
  CHECK(scenario.criteria[0].metric == Metric::path_length_mm);

  // A step without a limit of its own has the exam's.
  CHECK(parse_scenario(with(kTinyScenario, "hold_s = 1.0\ntime_limit_s = 10", "hold_s = 1.0"), "x")
            .steps[0]
            .time_limit_s == 30);
}

TEST_CASE("the bundled scenarios are well formed") {
  int found = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(INSONATE_ASSETS_FOLDER) / "scenarios")) {
    CHECK_NOTHROW(read_scenario(entry.path()));
    ++found;
  }
  CHECK(found > 0);
}

TEST_CASE("what is wrong in a scenario is said in words") {
  struct Row {
    const char* from;
    const char* to;
    std::vector<const char*> words;
  };
  const std::vector<Row> rows{
      {"format = 1", "format = 3", {"line 2, column 10", "format 3", "formats 1 and 2"}},
      {"format = 1\n", "", {"the key 'format' is missing"}},
      {"title = \"Find the ball\"", "title = 7", {"line 3", "not a text"}},
      {"title = \"Find the ball\"", "title = \"  \"", {"'title' is empty"}},
      {"case = \"tiny\"", "", {"the key 'case' is missing"}},
      {"case = \"tiny\"",
       "kase = \"tiny\"",
       {"the key 'kase' is unknown here", "did you mean 'case'?", "the key 'case' is missing"}},
      {"pass_mark_percent = 60", "pass_mark_percent = 160", {"160", "0 to 100"}},
      {"pass_mark_percent = 60", "pass_mark_percent = \"60\"", {"line 5, column 21", "not a number"}},
      {"pass_mark_percent = 60", "pass_mark_percent = nan", {"'pass_mark_percent' is nan"}},
      {"time_limit_s = 30", "time_limit_s = -1", {"-1", "from 1"}},
      {"time_limit_s = 30",
       "time_limit_s = 30\nlocked = [\"frequncy\"]",
       {"line 7", "'frequncy' is not a setting", "did you mean 'frequency'?"}},
      {"time_limit_s = 30", "time_limit_s = inf", {"'time_limit_s' is inf"}},
      {"time_limit_s = 30", "time_limit_s = 30\n[phantom]\nfluid = true", {"phantom options", "'tiny'"}},
      {"kind = \"find_view\"", "kind = \"find_veiw\"", {"step 1", "'find_veiw'", "did you mean 'find_view'?"}},
      {"view = \"ball\"", "", {"step 1: the key 'view' is missing"}},
      {"hold_s = 1.0", "hold_s = 0", {"step 1", "'hold_s' is 0", "0.1 to 60"}},
      {"hold_s = 1.0", "hold_s = 12", {"held longer", "shorten"}},
      {"hold_s = 1.0", "hold_s = 1.0\nholt_s = 2", {"the key 'holt_s' is unknown here", "did you mean 'hold_s'?"}},
      {"plane_distance_mm = 8",
       "plane_distance = 8",
       {"line 17, column 1", "'plane_distance'", "did you mean 'plane_distance_mm'?"}},
      {"plane_distance_mm = 8",
       "plane_distance_mm = true",
       {"'plane_distance_mm' is not a number; give a number from 0 to 1000"}},
      {"plane_distance_mm = 8", "time_s = 8", {"not a metric of a picture"}},
      {"plane_distance_mm = 8\nplane_angle_deg = 20", "", {"[step.tolerance] of step 1: it is empty"}},
      {"metric = \"plane_distance_mm\"",
       "metric = \"plane_distanse_mm\"",
       {"criterion 1 of step 1", "did you mean 'plane_distance_mm'?"}},
      {"metric = \"target_insonated_percent\"\nfull = 80\nzero = 20",
       "metric = \"plane_distance_mm\"\nfull = 2\nzero = 20",
       {"criterion 2 of step 1", "another criterion marks plane_distance_mm already"}},
      {"full = 2", "full = 12", {"criterion 1 of step 1", "'full' is 12 and 'zero' is 10", "below 'zero'"}},
      {"full = 80", "full = 20", {"above 'zero'"}},
      {"full = 2\n", "", {"the key 'full' is missing"}},
      {"weight = 4", "weight = 0", {"'weight' is 0"}},
      {"weight = 4", "weight = -1", {"'weight' is -1"}},
      {"critical = true", "critical = 1", {"neither true nor false"}},
      {"[[criterion]]\nmetric = \"path_length_mm\"",
       "[[criterion]]\nmetric = \"tilt_deg\"",
       {"only a step has", "[[step.criterion]]"}},
      {"[[criterion]]", "[criterion]", {"not a list of tables", "[[criterion]]"}},
      {"[step.tolerance]", "[step.tolerance", {"this is not TOML", "line 16"}},
      {"format = 1", "format = 1\nformat = 1", {"this is not TOML"}},
  };
  for (const Row& row : rows) {
    const std::string message = refusal(with(kTinyScenario, row.from, row.to));
    INFO(row.from << " -> " << row.to << "\n" << message);
    CHECK(message.find("exam.toml") == 0);
    for (const char* word : row.words) {
      INFO(word);
      CHECK(message.find(word) != std::string::npos);
    }
  }
}

TEST_CASE("a scenario without steps, or one that marks nothing, is refused") {
  CHECK(refusal("format = 1\ntitle = \"x\"\ncase = \"abdomen\"\ntime_limit_s = 5\n").find("there are no steps") !=
        std::string::npos);
  const char* unmarked =
      "format = 1\ntitle = \"x\"\ncase = \"abdomen\"\ntime_limit_s = 5\n[[step]]\nkind = \"find_view\"\ntitle = \"a\"\n"
      "instruction = \"b\"\nview = \"c\"\n[step.tolerance]\ntilt_deg = 5\n";
  CHECK(refusal(unmarked).find("marks nothing") != std::string::npos);
  CHECK(refusal("").find("the key 'title' is missing") != std::string::npos);
  CHECK(refusal("\x01\xff\x00garbage").find("not TOML") != std::string::npos);
}

TEST_CASE("all problems of a scenario come at once, in the order of the file") {
  std::string text = with(kTinyScenario, "title = \"Find the ball\"", "titel = \"Find the ball\"");
  text = with(text, "weight = 4", "weight = \"four\"");
  text = with(text, "view = \"ball\"\nhold_s = 0.5", "hold_s = 0.5");
  try {
    parse_scenario(text, "exam.toml");
    FAIL("it was read");
  } catch (const ScenarioError& error) {
    REQUIRE(error.problems().size() == 4);
    INFO(error.what());
    for (std::size_t i = 1; i < error.problems().size(); ++i)
      CHECK(error.problems()[i - 1].place.line <= error.problems()[i].place.line);
    const std::string message = error.what();
    CHECK(message.find("4 problems") != std::string::npos);
    for (const char* word :
         {"'titel'", "the key 'title' is missing", "'weight' is not a number", "step 2: the key 'view' is missing"})
      CHECK(message.find(word) != std::string::npos);
  }
}

TEST_CASE("of a metric that does not exist no more is said than that") {
  const std::string question =
      "[[step]]\nkind = \"question\"\ntitle = \"x\"\ninstruction = \"x\"\nchoices = [\"a\", \"b\"]\nright = \"a\"\n"
      "[[step.criterion]]\nmetric = \"answer_rihgt_percent\"\nfull = 100\nzero = 0\n";
  const std::string message = refusal(kTinyScenario + question);
  INFO(message);
  CHECK(message.find("did you mean 'answer_right_percent'?") != std::string::npos);
  CHECK(message.find("problems") == std::string::npos);
}

TEST_CASE("what an exam locks no step asks for, nor a view of another probe") {
  const auto locking = [](const std::string& settings) {
    return with(kTinyScenario, "time_limit_s = 30", "time_limit_s = 30\nlocked = [" + settings + "]");
  };
  CHECK(parse_scenario(kTinyScenario, "x").locked.empty());
  CHECK(parse_scenario(locking("\"probe\", \"gain\""), "x").locked == std::set{ActionKind::probe, ActionKind::gain});
  CHECK_THROWS_WITH(parse_scenario(locking("\"depth\""), "x"), Catch::Contains("add \"probe\""));
  const std::string knobs =
      "[[step]]\nkind = \"set_knobs\"\ntitle = \"x\"\ninstruction = \"x\"\ndepth_mm = [90, 120]\n"
      "[[step.criterion]]\nmetric = \"knobs_right_percent\"\nfull = 100\nzero = 0\n";
  CHECK_NOTHROW(parse_scenario(locking("\"gain\", \"probe\"") + knobs, "x"));
  CHECK_THROWS_WITH(parse_scenario(locking("\"depth\", \"probe\"") + knobs, "x"),
                    Catch::Contains("step 3: the step asks for the depth, which the exam locks"));
  for (const auto& [from, to] :
       {std::pair{"plane_distance_mm = 8\n", "plane_distance_mm = 8\ndepth_use_percent = 50\n"},
        {"metric = \"target_insonated_percent\"", "metric = \"depth_use_percent\""}}) {
    CHECK_NOTHROW(parse_scenario(with(kTinyScenario, from, to), "x"));
    CHECK_THROWS_WITH(parse_scenario(with(locking("\"probe\", \"depth\""), from, to), "x"), Catch::Contains("locks"));
  }

  const Scenario scenario = parse_scenario(
      with(locking("\"probe\""), "view = \"ball\"\nhold_s = 0.5", "view = \"bare\"\nhold_s = 0.5"), "exam.toml");
  Case subject = tiny_case();
  CHECK_NOTHROW(check_against_case(scenario, subject));
  subject.views[1].probe = "linear";
  CHECK_THROWS_WITH(check_against_case(scenario, subject),
                    Catch::Contains("step 2 shows the view 'bare' with the probe 'linear'"));
}

TEST_CASE("names are checked against the case, with the name that was meant") {
  Scenario scenario =
      parse_scenario(with(kTinyScenario, "view = \"ball\"\nhold_s = 0.5", "view = \"bal\"\nhold_s = 0.5"), "exam.toml");
  CHECK_THROWS_WITH(check_against_case(scenario, tiny_case()), Catch::Contains("step 2 names the view 'bal'") &&
                                                                   Catch::Contains("did you mean 'ball'?") &&
                                                                   Catch::Contains("line 37, column 8"));

  // Two steps that both ask for targets of a view that has none: both are named.
  scenario = parse_scenario(kTinyScenario, "exam.toml");
  scenario.steps[0].view = "bare";
  scenario.steps[1].view = "nothing like it";
  CHECK_THROWS_WITH(check_against_case(scenario, tiny_case()), Catch::Contains("2 problems") &&
                                                                   Catch::Contains("names no targets") &&
                                                                   Catch::Contains("use one of 'ball', 'bare'"));

  Case without_labels = tiny_case();
  without_labels.labels.voxels.clear();
  CHECK_THROWS_WITH(check_against_case(parse_scenario(kTinyScenario, "exam.toml"), without_labels),
                    Catch::Contains("has no labels"));
  CHECK_NOTHROW(check_against_case(parse_scenario(kTinyScenario, "exam.toml"), tiny_case()));
}

TEST_CASE("whatever a scenario file holds, it is read or refused in words") {
  const std::string whole = kTinyScenario;
  int refused = 0;
  const auto feed = [&](const std::string& text) {
    try {
      parse_scenario(text, "exam.toml");
    } catch (const InputError& error) {
      ++refused;
      CHECK(std::string(error.what()).rfind("exam.toml: ", 0) == 0);
    }
  };
  for (std::size_t length = 0; length < whole.size(); length += 3) feed(whole.substr(0, length));
  for (std::uint32_t i = 0; i < 1500; ++i) {
    std::string flipped = whole;
    flipped[hash(1, i) % whole.size()] = char(hash(2, i) & 0xff);
    feed(flipped);
  }
  CHECK(refused > 700);
}

TEST_CASE("phantom options are passed as they are written") {
  std::string text = with(kTinyScenario, "case = \"tiny\"", "case = \"abdomen\"");
  text += "[phantom]\nfree_fluid = true\naorta_diameter_mm = 45.25\nvoxel_mm = 2\n";
  const auto options = parse_scenario(text, "exam.toml").phantom_options;
  CHECK(options == std::vector<std::pair<std::string, std::string>>{
                       {"aorta_diameter_mm", "45.25"}, {"free_fluid", "true"}, {"voxel_mm", "2"}});
}

TEST_CASE("a scenario file that is not there or empty is refused") {
  CHECK_THROWS_AS(read_scenario("/nowhere/exam.toml"), InputError);
  CHECK_THROWS_AS(read_scenario(INSONATE_ASSETS_FOLDER), InputError);
}
