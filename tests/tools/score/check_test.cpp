// insonate-score check: faults of a scenario's text, of its variants and of their patients.

#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/tools/score/score_program.h"

using namespace insonate;

TEST_CASE("insonate-score check passes the bundled exam") {
  const TemporaryFolder folder;
  const ProgramOutcome outcome = run_score("check " + folder.put("exam.toml", coarse_exam()).string());
  INFO(outcome.errors);
  CHECK(outcome.code == 0);
  CHECK(outcome.output.find("no problems found") != std::string::npos);
}

TEST_CASE("insonate-score check reports faults of a scenario's text and then of its case") {
  const TemporaryFolder folder;
  std::string exam = coarse_exam();
  const auto spoil = [&](const std::string& from, const std::string& to) { replace_first(exam, from, to); };
  spoil("view = \"hepatorenal\"", "view = \"hepatorenl\"");
  spoil("pass_mark_percent", "pass_mark");
  const std::string file = folder.put("exam.toml", exam).string();
  const ProgramOutcome outcome = run_score("check " + file);
  INFO(outcome.errors);
  CHECK(outcome.code == 2);
  CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 2);
  CHECK(outcome.errors.find("'pass_mark'") < outcome.errors.find("did you mean 'hepatorenal'?"));
  CHECK(outcome.errors.find("did you mean 'hepatorenal'?") != std::string::npos);

  INFO("of a step of no kind there is still the view to look at");
  spoil("kind = \"find_view\"", "kind = \"find_vew\"");
  const ProgramOutcome unknown = run_score("check " + folder.put("kind.toml", exam).string());
  CHECK(unknown.code == 2);
  CHECK(unknown.errors.find("2 problems") != std::string::npos);
  CHECK(unknown.errors.find("did you mean 'hepatorenal'?") != std::string::npos);
  CHECK(unknown.errors.find("marks nothing") == std::string::npos);
  const ProgramOutcome text = run_score("check --without-case " + file);
  CHECK(text.code == 2);
  CHECK(text.errors.find("hepatorenl") == std::string::npos);
}

TEST_CASE("insonate-score check reports what is wrong with every variant and its patient, each where it stands") {
  const TemporaryFolder folder;
  std::string exam = coarse_exam();
  const auto spoil = [&](const std::string& from, const std::string& to) { replace_first(exam, from, to); };
  spoil("view = \"hepatorenal\"", "view = \"${view}\"");
  spoil("[phantom] ",
        "[[variant]]\nname = \"one\"\nphantom = { fre_fluid = true }\nwords = { view = \"hepatorenl\" }\n\n"
        "[[variant]]\nname = \"two\"\nphantom = { aorta_diameter_mm = 900 }\nwords = { view = \"liver_lng\" }\n\n"
        "[[variant]]\nname = \"three\"\ncase = \"gone\"\nwords = { view = \"hepatorenal\" }\n\n[phantom] ");
  spoil("metric = \"plane_angle_deg\"", "metric = \"plane_angel_deg\"");
  const ProgramOutcome outcome = run_score("check " + folder.put("exam.toml", exam).string());
  INFO(outcome.errors);
  CHECK(outcome.code == 2);
  const auto line_of = [&](const std::string& text) {
    return "line " + std::to_string(1 + std::count(exam.begin(), exam.begin() + long(exam.find(text)), '\n')) + ",";
  };
  const auto reported = [&](const std::string& at, const std::string& words) {
    INFO(words);
    const std::size_t found = outcome.errors.find(words);
    REQUIRE(found != std::string::npos);
    const std::size_t line = outcome.errors.rfind("line ", found);
    CHECK(outcome.errors.substr(line, line_of(at).size()) == line_of(at));
  };
  reported("fre_fluid", "the phantom's option 'fre_fluid': the recipe has no such option; did you mean 'free_fluid'?");
  reported("900", "the phantom's option 'aorta_diameter_mm': '900' is out of range");
  reported("\"gone\"", "the case 'gone' is not a folder beside the file");
  reported("${view}", "the view 'hepatorenl'");
  reported("${view}", "the view 'liver_lng'");
  reported("plane_angel_deg", "did you mean 'plane_angle_deg'?");
  CHECK(outcome.errors.find("'hepatorenal', which") == std::string::npos);
}

TEST_CASE("insonate-score check reports faults of the text, then of each patient, with progress on a terminal alone") {
  const TemporaryFolder folder;
  std::string exam = coarse_exam();
  replace_first(exam, "view = \"hepatorenal\"", "view = \"${view}\"");
  replace_first(exam, "pass_mark_percent", "pass_mark");
  replace_first(exam, "[phantom] ",
                "[[variant]]\nname = \"one\"\nwords = { view = \"hepatorenal\" }\n\n"
                "[[variant]]\nname = \"two\"\nwords = { view = \"hepatorenl\" }\n\n[phantom] ");
  const std::string file = folder.put("exam.toml", exam).string();
  const ProgramOutcome seen =
      run_program("script -qefc '" INSONATE_SCORE_PROGRAM " check " + file + "' /dev/null </dev/null");
  INFO(seen.output);
  CHECK(seen.code == 2);
  std::size_t before = 0;
  for (const char* next :
       {"'pass_mark'", "variant 1 of 2, one: ", "variant 2 of 2, two: ", " s left", "'hepatorenl'"}) {
    const std::size_t at = seen.output.find(next, before);
    INFO(next);
    REQUIRE(at != std::string::npos);
    before = at;
  }

  const ProgramOutcome piped = run_score("check " + file);
  CHECK(piped.code == 2);
  CHECK(piped.output.empty());
  CHECK(std::count(piped.errors.begin(), piped.errors.end(), '\n') == 2);
  CHECK(piped.errors.find("'hepatorenl'") != std::string::npos);
  CHECK(piped.errors.find("variant 1 of") == std::string::npos);
  CHECK(piped.errors.find('\r') == std::string::npos);
}
