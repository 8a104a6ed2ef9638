#include "scenarios/results/export/results_export.h"

#include <catch2/catch.hpp>

#include "scenarios/results/measured.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "tests/scenarios/results/csv_cells.h"
#include "tests/scenarios/results/made_attempt.h"

using namespace insonate;

namespace {

TinyExam exam_of(double offset_mm, AttemptMode mode) {
  TinyExam exam = tiny_exam(offset_mm);
  exam.result.provenance.mode = mode;
  exam.attempt.score_json = to_json(exam.result);
  return exam;
}

}  // namespace

TEST_CASE("the tables of a database have all learners, attempts, scores and comments") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  const TinyExam good = exam_of(1.0 / 3, AttemptMode::exam), poor = exam_of(70, AttemptMode::practice);
  for (const auto& [learner, exam] : {std::pair{"L-01", &poor}, {"L-01", &good}, {"-02", &poor}}) {
    Attempt attempt = made_attempt(learner, *exam);
    database.add(attempt);
  }
  Comment comment;
  comment.attempt = 2;
  comment.author = "T-02";
  comment.written_ms = 1'795'284'309'250;
  comment.text = "=1+1, \"well\"";
  database.add(comment);

  const ExportedResults exported = export_results(database, folder / "new/tables");
  CHECK(exported.problems.empty());
  REQUIRE(exported.files.size() == 4);
  const auto table = [&](const char* name) {
    const std::string csv = read_file(folder.path / "new/tables" / name);
    CHECK(csv.ends_with("\r\n"));
    const auto rows = rows_of(csv);
    for (const auto& row : rows) CHECK_FALSE(row.contains("wrong"));
    return rows;
  };
  auto learners = table("learners.csv");
  REQUIRE(learners.size() == 2);
  CHECK(learners[0]["learner"] == "'-02");  // which a spreadsheet would read as a number
  CHECK(learners[0]["best_percent"].empty());
  CHECK(learners[1]["attempts"] == "2");
  CHECK(learners[1]["exams"] == "1");
  CHECK(learners[1]["passed"] == "1");
  CHECK(std::stod(learners[1]["best_percent"]) == good.result.percent);
  CHECK(learners[1]["last_finished"] == "2026-11-21T18:05:09.250Z");

  auto attempts = table("attempts.csv");
  REQUIRE(attempts.size() == 3);
  CHECK(attempts[1]["attempt"] == "2");
  CHECK(attempts[1]["learner"] == "L-01");
  CHECK(attempts[1]["mode"] == "exam");
  CHECK(attempts[1]["exam"] == "Find the ball");
  CHECK(std::stod(attempts[1]["percent"]) == good.result.percent);
  CHECK(attempts[1]["passed"] == "1");
  CHECK(attempts[1]["complete"] == "1");
  CHECK(attempts[1]["comments"] == "1");
  CHECK(attempts[0]["comments"] == "0");
  CHECK(attempts[1]["uuid"] == database.read(2).uuid);
  CHECK(std::stod(attempts[1]["pass_mark_percent"]) == good.result.pass_mark_percent);
  CHECK(std::stod(attempts[1]["points"]) == good.result.points);
  CHECK(std::stod(attempts[1]["time_s"]) == good.result.motion.time_s);
  CHECK(attempts[1]["scoring_version"] == std::to_string(good.result.provenance.scoring_version));
  CHECK(attempts[0]["mode"] == "practice");

  const auto scores = table("scores.csv");
  CHECK(scores.size() == measured(good.result).size() + 2 * measured(poor.result).size());
  CHECK(scores.front().at("attempt") == "1");
  CHECK(scores.back().at("attempt") == "3");

  auto comments = table("comments.csv");
  REQUIRE(comments.size() == 1);
  CHECK(comments[0]["comment"] == "1");
  CHECK(comments[0]["attempt"] == "2");
  CHECK(comments[0]["learner"] == "L-01");
  CHECK(comments[0]["author"] == "T-02");
  CHECK(comments[0]["written"] == "2026-11-21T18:05:09.250Z");
  CHECK(comments[0]["text"] == "'=1+1, \"well\"");

  INFO("nothing is written over");
  CHECK_THROWS_WITH(export_results(database, folder / "new/tables"), Catch::Contains("name a folder that is new"));
  write_file(folder / "taken", "x");
  CHECK_THROWS_AS(export_results(database, folder / "taken"), InputError);
  CHECK(read_file(folder / "taken") == "x");
  CHECK_THROWS_AS(export_results(database, folder / "taken/below"), InputError);
}

TEST_CASE("an attempt whose score is damaged has a row, and prevents no other") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  for (const char* learner : {"L-01", "L-02"}) {
    Attempt attempt = made_attempt(learner, tiny_exam(0));
    database.add(attempt);
  }
  sqlite::Connection(folder / "results.db", false).run("UPDATE attempt SET score = '{}' WHERE number = 1");
  const ExportedResults exported = export_results(database, folder / "tables");
  REQUIRE(exported.problems.size() == 1);
  CHECK(exported.problems[0].find("results.db: attempt 1: ") != std::string::npos);
  const auto attempts = rows_of(read_file(folder / "tables/attempts.csv"));
  REQUIRE(attempts.size() == 2);
  CHECK_FALSE(attempts[0].contains("wrong"));
  CHECK(attempts[0].at("learner") == "L-01");
  CHECK(attempts[0].at("points").empty());
  CHECK_FALSE(attempts[1].at("points").empty());
  for (const auto& row : rows_of(read_file(folder / "tables/scores.csv"))) CHECK(row.at("attempt") == "2");
}

TEST_CASE("an empty database has tables of headers") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  for (const auto& file : export_results(database, folder / "tables").files) CHECK(rows_of(read_file(file)).empty());
}
