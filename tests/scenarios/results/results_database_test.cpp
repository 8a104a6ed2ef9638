#include "scenarios/results/results_database.h"

#include <catch2/catch.hpp>

#include "sim/core/input_error.h"
#include "tests/scenarios/results/made_attempt.h"

using namespace insonate;

TEST_CASE("an attempt comes back from the database to the byte, and later ones leave it alone") {
  const ResultsFolder folder;
  Attempt first = made_attempt("L-01", tiny_exam(0), std::string("bytes\0\xff\n", 8));
  first.patient = "/cases/7";
  {
    ResultsDatabase database = ResultsDatabase::open_or_make(folder / "new/results.db");
    database.add(first);
    Attempt second = made_attempt("L-02", tiny_exam(70), "");
    database.add(second);
    CHECK(first.number == 1);
    CHECK(second.number == 2);
    CHECK(first.uuid != second.uuid);
    CHECK(first.uuid.size() == 36);
    CHECK(first.uuid[14] == '4');
  }
  ResultsDatabase database = ResultsDatabase::open(folder / "new/results.db");
  const Attempt back = database.read(1);
  CHECK(back.number == 1);
  CHECK(back.uuid == first.uuid);
  CHECK(back.learner == first.learner);
  CHECK(back.finished_ms == first.finished_ms);
  CHECK(back.scenario_text == first.scenario_text);
  CHECK(back.scenario_file == first.scenario_file);
  CHECK(back.patient == first.patient);
  CHECK(back.log == first.log);
  CHECK(back.score_json == first.score_json);
  CHECK(back.trace_json == first.trace_json);
  CHECK(back.database == first.database);
  CHECK(back.database.size() == 32);
  REQUIRE(back.pictures.size() == first.pictures.size());
  for (std::size_t i = 0; i < back.pictures.size(); ++i) {
    CHECK(back.pictures[i].step == first.pictures[i].step);
    CHECK(back.pictures[i].kind == first.pictures[i].kind);
    CHECK(back.pictures[i].png == first.pictures[i].png);
  }
  CHECK(database.read(2).log.empty());
  database.check();
  CHECK_THROWS_AS(database.read(3), InputError);
}

TEST_CASE("lists say who took what, and how it went") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  const TinyExam good = tiny_exam(0), poor = tiny_exam(70);
  REQUIRE(good.result.passed);
  REQUIRE_FALSE(poor.result.passed);
  for (const auto& [learner, exam] : {std::pair{"b", &poor}, {"a", &poor}, {"b", &good}}) {
    Attempt attempt = made_attempt(learner, *exam);
    attempt.finished_ms += database.attempts().size() * 1000;
    database.add(attempt);
  }
  const auto attempts = database.attempts();
  REQUIRE(attempts.size() == 3);
  CHECK(attempts[0].learner == "b");
  CHECK(attempts[0].percent == poor.result.percent);
  CHECK(attempts[2].passed);
  CHECK(attempts[2].title == "Find the ball");
  CHECK(attempts[2].complete);
  const auto learners = database.learners();
  REQUIRE(learners.size() == 2);
  CHECK(learners[0].id == "a");
  CHECK(learners[1].attempts == 2);
  CHECK(learners[1].passed == 1);
  CHECK(learners[1].best_percent == good.result.percent);
  CHECK(learners[1].last_ms == attempts[2].finished_ms);
}

TEST_CASE("what is no attempt leaves nothing behind") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  Attempt named = made_attempt("Ada Lovelace", tiny_exam(0));
  CHECK_THROWS_AS(database.add(named), InputError);
  Attempt scoreless = made_attempt("a", tiny_exam(0));
  scoreless.score_json = "{}";
  CHECK_THROWS_AS(database.add(scoreless), InputError);
  CHECK(database.attempts().empty());
  CHECK(database.learners().empty());
}

TEST_CASE("times are written in UTC") {
  CHECK(utc_time(0) == "1970-01-01T00:00:00.000Z");
  CHECK(utc_time(1'795'284'309'250) == "2026-11-21T18:05:09.250Z");
  CHECK(utc_time(1'709'164'800'007) == "2024-02-29T00:00:00.007Z");
}
