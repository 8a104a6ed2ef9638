#include "scenarios/results/rescoring.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "sim/core/input_error.h"
#include "tests/scenarios/results/made_attempt.h"

using namespace insonate;

TEST_CASE("a score is the same to the bit or it is said why not") {
  const ExamResult then = tiny_exam(1.0 / 3).result;
  const std::string json = to_json(then);
  ExamResult now = then;
  now.provenance.program_version = "another";
  now.provenance.mode = AttemptMode::exam;
  now.provenance.log = "elsewhere.igs.mha";
  CHECK(why_different(json, now, "x").empty());

  INFO("an older score does not name the limits that were missed, a newer one may");
  now.steps[0].facts.emplace_back(StepResult::kNotHeld, "5 mm");
  CHECK(why_different(json, now, "x").empty());
  const std::string newer = to_json(now);
  now.steps[0].facts.back().second = "6 mm";
  CHECK(why_different(newer, now, "x").find("steps/0/facts/") == 0);
  now = then;

  now.motion.path_length_mm = std::nextafter(now.motion.path_length_mm, 1e9);
  CHECK(why_different(json, now, "x").find("motion/path_length_mm: ") == 0);
  now = then;
  now.steps[0].criteria[0].points += 1;
  CHECK(why_different(json, now, "x").find("steps/0/criteria/0/points") == 0);
  now = then;
  now.provenance.case_digest = "0123";
  CHECK(why_different(json, now, "x") == "the case is another, " + then.provenance.case_digest +
                                             " then and 0123 now; all marks and values are the same");
  now.provenance.scoring_version = 99;
  now.percent = 3;
  const std::string why = why_different(json, now, "x");
  CHECK(why.find("the scoring's version is another, ") == 0);
  CHECK(why.find("; the case is another") != std::string::npos);
  CHECK(why.find("; percent: ") != std::string::npos);
  CHECK_THROWS_AS(why_different("{}", now, "x"), InputError);
}
