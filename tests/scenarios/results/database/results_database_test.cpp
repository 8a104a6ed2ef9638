#include "scenarios/results/database/results_database.h"

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

TEST_CASE("an exam under way is kept part by part until an attempt takes its place") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  Sitting sitting;
  sitting.learner = "L-01";
  sitting.title = "Ball";
  sitting.scenario_text = kTinyScenario;
  sitting.scenario_file = "/exams/exam.toml";
  sitting.patient = "/cases/7";
  sitting.seed = 4'000'000'000;
  const std::int64_t before_ms = now_since_1970_ms();
  database.begin(sitting, "first");
  CHECK(sitting.number == 1);
  database.add_part(1, std::string("second\0", 7));
  const std::int64_t after_ms = now_since_1970_ms();
  Sitting other = sitting;
  other.learner = "L-02";
  database.begin(other, "");

  const std::vector<Sitting> kept = database.sittings();
  REQUIRE(kept.size() == 2);
  CHECK(kept[0].number == 1);
  CHECK(kept[0].learner == "L-01");
  CHECK(kept[0].began_ms == sitting.began_ms);
  CHECK(before_ms <= kept[0].began_ms);
  CHECK(kept[0].began_ms <= kept[0].kept_ms);
  CHECK(kept[0].kept_ms <= after_ms);
  CHECK(kept[0].title == "Ball");
  CHECK(kept[0].scenario_text == kTinyScenario);
  CHECK(kept[0].scenario_digest == sitting.scenario_digest);
  CHECK(kept[0].scenario_file == "/exams/exam.toml");
  CHECK(kept[0].patient == "/cases/7");
  CHECK(kept[0].seed == 4'000'000'000);
  CHECK(kept[1].learner == "L-02");
  CHECK(database.parts(1) == std::vector<std::string>{"first", std::string("second\0", 7)});
  CHECK(database.parts(2) == std::vector<std::string>{""});
  database.check();

  Attempt attempt = made_attempt("L-01", tiny_exam(0));
  database.add(attempt, 1);
  CHECK(database.attempts().size() == 1);
  CHECK(database.sittings().size() == 1);
  CHECK(database.parts(1).empty());
  database.remove(2);
  CHECK(database.sittings().empty());
  CHECK(sqlite::Connection(folder / "results.db", false).number("SELECT count(*) FROM learner") == 1);
  database.check();
}

TEST_CASE("nobody takes an exam twice, at two stations, or once more when it has been handed in for them") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  Sitting sitting;
  sitting.learner = "L-01";
  sitting.scenario_text = kTinyScenario;
  database.begin(sitting, "first");
  CHECK_THROWS_AS(database.check_not_taken("L-01", sitting.scenario_digest), ExamTaken);
  CHECK_NOTHROW(database.check_not_taken("L-02", sitting.scenario_digest));
  CHECK_NOTHROW(database.check_not_taken("L-01", "another"));
  Sitting twice = sitting;
  CHECK_THROWS_AS(database.begin(twice, "x"), ExamTaken);
  Sitting another = sitting;
  another.scenario_text += "\n";
  database.begin(another, "x");
  CHECK(database.sittings().size() == 2);

  Attempt attempt = made_attempt("L-01", tiny_exam(0)), again = attempt;
  database.add(attempt, sitting.number);
  CHECK_THROWS_AS(database.add(again, sitting.number), ExamTaken);
  CHECK(again.number == 0);
  CHECK(database.attempts().size() == 1);
  CHECK_THROWS_AS(database.add_part(sitting.number, "third"), ExamTaken);
  CHECK_THROWS_AS(database.remove(sitting.number), ExamTaken);
  CHECK_THROWS_WITH(database.begin(twice, "x"), Catch::Contains("as attempt 1"));
  database.check();
}

TEST_CASE("only an exam that counted stands in the way of taking it") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  TinyExam exam = tiny_exam(0);
  const auto add = [&](std::optional<AttemptMode> mode) {
    exam.result.provenance.mode = mode;
    exam.attempt.score_json = to_json(exam.result);
    Attempt attempt = made_attempt("L-0" + std::to_string(database.attempts().size()), exam);
    database.add(attempt);
    CHECK(database.attempts().back().mode == mode);
    return attempt.learner;
  };
  const std::string digest = exam.result.provenance.scenario_digest;
  CHECK_NOTHROW(database.check_not_taken(add(AttemptMode::practice), digest));
  CHECK_NOTHROW(database.check_not_taken(add(AttemptMode::recording), digest));
  CHECK_THROWS_AS(database.check_not_taken(add(AttemptMode::exam), digest), ExamTaken);
  CHECK_THROWS_AS(database.check_not_taken(add(std::nullopt), digest), ExamTaken);

  INFO("and of a learner's attempts only exams are passed or the best");
  const auto learners = database.learners();
  REQUIRE(learners.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(learners[i].id == "L-0" + std::to_string(i));
    CHECK(learners[i].attempts == 1);
    CHECK(learners[i].exams == (i < 2 ? 0 : 1));
    CHECK(learners[i].passed == learners[i].exams);
    CHECK(learners[i].best_percent.has_value() == (i >= 2));
  }
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

TEST_CASE("JSON that is not an attempt leaves nothing behind") {
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
