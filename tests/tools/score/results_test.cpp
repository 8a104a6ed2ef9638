// The commands of insonate-score that work on a database of results.

#include <catch2/catch.hpp>

#include <utility>

#include "scenarios/result_json.h"
#include "scenarios/results/database/results_database.h"
#include "scenarios/results/trace_json.h"
#include "tests/tools/score/score_program.h"

using namespace insonate;

TEST_CASE(
    "insonate-score keeps attempts, lists them, scores them again to the same bits, and makes their reports again") {
  const TemporaryFolder folder;
  const auto exam = folder.put("exam.toml", coarse_exam());
  const std::string database = (folder.path / "lab.db").string();
  std::string scores[2];
  for (const char* scan : {"good", "poor"}) {
    const auto log = kAssets / "logs" / ("ruq_" + std::string(scan) + ".igs.mha");
    const ProgramOutcome outcome = run_score("--log " + log.string() + " --scenario " + exam.string() + " --results " +
                                             database + " --learner L-" + scan);
    INFO(outcome.errors);
    REQUIRE(outcome.code == 0);
    scores[scan == std::string("poor")] = outcome.output;
  }

  const std::string attempts = run_score("attempts " + database).output;
  CHECK(attempts.find("L-good") < attempts.find("L-poor"));
  CHECK(attempts.find(" passed ") < attempts.find("not passed"));
  CHECK(run_score("attempts " + database + " --learner L-poor").output.find("L-good") == std::string::npos);
  CHECK(attempts.find(" recording ") != std::string::npos);
  CHECK(run_score("attempts " + database + " --mode exam").output.find("L-") == std::string::npos);
  CHECK(run_score("learners " + database).output.find("L-poor") != std::string::npos);

  const ProgramOutcome again = run_score("rescore " + database);
  INFO(again.output << again.errors);
  CHECK(again.code == 0);
  CHECK(again.output == "attempt 1: the same\nattempt 2: the same\n2 the same, 0 not\n");

  REQUIRE(run_score("report " + database + " --attempt 2 --out " + folder.path.string()).code == 0);
  CHECK(read_file(folder.path / "attempt-2" / "score.json") == scores[1]);
  CHECK(read_file(folder.path / "attempt-2" / "report.html").find("L-poor") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder.path / "attempt-1"));

  // Another case in its place: the same scenario text, but the folder it names has gone.
  ResultsDatabase opened = ResultsDatabase::open(database);
  Attempt moved = opened.read(1);
  moved.patient = (folder.path / "gone").string();
  opened.add(moved);
  Attempt other = opened.read(1);
  const std::string points = "\"passed\": true";
  other.score_json.replace(other.score_json.find(points), points.size(), "\"passed\": false");
  opened.add(other);
  const ProgramOutcome different = run_score("rescore " + database);
  CHECK(different.code == 1);
  CHECK(different.output.find("attempt 3: it cannot be scored: ") != std::string::npos);
  CHECK(different.output.find("attempt 4: passed: false then, true now\n") != std::string::npos);
}

TEST_CASE("insonate-score makes the other reports when an attempt is damaged") {
  const TemporaryFolder folder;
  const std::string database = (folder.path / "lab.db").string();
  for (int i = 0; i < 3; ++i) {
    Attempt attempt;
    attempt.learner = "L-01";
    attempt.score_json = to_json(ExamResult());
    attempt.trace_json = to_json(std::vector<TracePoint>());
    ResultsDatabase::open_or_make(database).add(attempt);
  }
  sqlite::Connection(database, false).run("UPDATE attempt SET log_digest = 'x' WHERE number = 2");
  const ProgramOutcome outcome = run_score("report " + database + " --out " + (folder.path / "reports").string());
  INFO(outcome.errors);
  CHECK(outcome.code == 2);
  CHECK(outcome.errors.find("attempt 2: its log is damaged") != std::string::npos);
  for (const int number : {1, 2, 3})
    CHECK(std::filesystem::exists(folder.path / ("reports/attempt-" + std::to_string(number)) / "report.html") ==
          (number != 2));
  sqlite::Connection(database, false).run("UPDATE attempt SET score = '{' WHERE number = 3");
  const ProgramOutcome without_score = run_score("report " + database + " --out " + (folder.path / "again").string());
  INFO(without_score.errors);
  CHECK(without_score.errors.find("lab.db: attempt 3: this is not a result of Insonate: line 1 is not JSON; score") !=
        std::string::npos);
}

TEST_CASE("insonate-score stores comments, lists and reports them, removes them, and writes all tables") {
  const TemporaryFolder folder;
  const std::string database = (folder.path / "lab.db").string();
  for (const auto& [learner, mode] : {std::pair{"L-01", AttemptMode::exam}, {"L-02", AttemptMode::practice}}) {
    ExamResult result;
    result.provenance.mode = mode;
    Attempt attempt;
    attempt.learner = learner;
    attempt.score_json = to_json(result);
    attempt.trace_json = to_json(std::vector<TracePoint>());
    ResultsDatabase::open_or_make(database).add(attempt);
  }
  const ProgramOutcome made = run_score("comment " + database + " --attempt 1 --author T-02 --text 'Slow down & hold'");
  INFO(made.errors);
  CHECK(made.code == 0);
  CHECK(made.output == "comment 1 on attempt 1\n");
  CHECK(run_score("comment " + database + " --attempt 2 --text 'Well held'").code == 0);

  const std::string attempts = run_score("attempts " + database).output;
  const std::size_t listed = attempts.find("\ncomment 1 on attempt 1 by T-02, 20");
  REQUIRE(listed != std::string::npos);
  CHECK(attempts.find("Z: Slow down & hold\n", listed) != std::string::npos);
  CHECK(attempts.find("\ncomment 2 on attempt 2, 20") != std::string::npos);
  CHECK(run_score("attempts " + database + " --learner L-01").output.find("comment 2") == std::string::npos);
  CHECK(run_score("attempts " + database + " --mode practice").output.find("comment 1 ") == std::string::npos);

  REQUIRE(run_score("report " + database + " --attempt 1 --out " + folder.path.string()).code == 0);
  CHECK(read_file(folder.path / "attempt-1/report.html").find("Slow down &amp; hold<small>T-02, ") !=
        std::string::npos);

  const std::string tables = (folder.path / "tables").string();
  const ProgramOutcome exported = run_score("export " + database + " --out " + tables);
  INFO(exported.errors);
  CHECK(exported.code == 0);
  CHECK(exported.output == "wrote " + tables + "/learners.csv\nwrote " + tables + "/attempts.csv\nwrote " + tables +
                               "/scores.csv\nwrote " + tables + "/comments.csv\n");
  CHECK(read_file(folder.path / "tables/comments.csv").find("\"T-02\"") != std::string::npos);

  CHECK(run_score("comment " + database + " --remove 1").output == "comment 1 is removed\n");
  CHECK(run_score("attempts " + database).output.find("comment 1 ") == std::string::npos);
  CHECK(run_score("attempts " + database).output.find("comment 2 ") != std::string::npos);

  INFO("an attempt that is damaged leaves the tables of the others");
  sqlite::Connection(database, false).run("UPDATE attempt SET score = '{}' WHERE number = 1");
  const ProgramOutcome partly = run_score("export " + database + " --out " + tables + "2");
  CHECK(partly.code == 2);
  CHECK(partly.errors.find("attempt 1: ") != std::string::npos);
  CHECK(std::filesystem::exists(tables + "2/attempts.csv"));
}

TEST_CASE("insonate-score sets a pass mark from two lists of learners") {
  const TemporaryFolder folder;
  const std::string database = (folder.path / "lab.db").string();
  ResultsDatabase opened = ResultsDatabase::open_or_make(database);
  const auto add = [&](const char* learner, double percent, const char* scenario = "exam",
                       AttemptMode mode = AttemptMode::exam) {
    ExamResult result;
    result.provenance.mode = mode;
    result.complete = true;
    result.percent = percent;
    Attempt attempt;
    attempt.learner = learner;
    attempt.scenario_text = scenario;
    attempt.score_json = to_json(result);
    opened.add(attempt);
  };
  // Means 40 and 80, equal deviations; neither practice nor the second attempt of a novice counts.
  add("n1", 90, "exam", AttemptMode::practice);
  for (const auto& [learner, percent] : {std::pair{"n1", 10.0},
                                         {"n2", 40.0},
                                         {"n3", 70.0},
                                         {"e1", 50.0},
                                         {"e2", 80.0},
                                         {"e3", 110.0},
                                         {"n1", 100.0},
                                         {"other", 5.0}})
    add(learner, percent);
  const std::string lists = " --novices " + folder.put("n.csv", "learner\nn1\nn2\nn3\nn4\n").string() + " --experts " +
                            folder.put("e.toml", "format = 1\nlearners = [\"e1\", \"e2\", \"e3\"]\n").string();
  const ProgramOutcome outcome = run_score("pass-mark " + database + lists);
  INFO(outcome.errors);
  CHECK(outcome.code == 0);
  CHECK(outcome.output.find("pass mark: 60.00 %\nnovices: 3 of 4 took it, mean 40.00 %") == 0);
  CHECK(outcome.output.find("false passes: 33.3 % observed, 25.2 % by the normal") != std::string::npos);

  const ProgramOutcome practice = run_score("pass-mark " + database + lists + " --mode practice");
  CHECK(practice.code == 2);
  CHECK(practice.errors.find("fewer than two scores of novices") != std::string::npos);

  add("n4", 20, "another exam");
  const ProgramOutcome several = run_score("pass-mark " + database + lists);
  CHECK(several.code == 2);
  CHECK(several.errors.find("2 different scenarios") != std::string::npos);
  CHECK(run_score("pass-mark " + database + lists + " --scenario " + folder.put("exam.toml", "exam").string()).output ==
        outcome.output);
}

TEST_CASE("insonate-score refuses databases and lists that it cannot use in one sentence") {
  const TemporaryFolder folder;
  const std::string text = folder.put("text.db", "no database").string();
  const std::string ids = folder.put("ids.csv", "learner\na\n").string();
  const auto refused = [&](const std::string& arguments, const std::string& words) {
    const ProgramOutcome outcome = run_score(arguments);
    INFO(arguments << "\n" << outcome.errors);
    CHECK(outcome.code == 2);
    CHECK(outcome.errors.find(words) != std::string::npos);
    CHECK(outcome.errors.find('\n') == outcome.errors.size() - 1);
  };
  for (const char* command : {"attempts ", "learners ", "rescore ", "report "}) {
    refused(command + text, "not a database of results");
    refused(command + (folder.path / "none.db").string(), "no such file");
  }
  refused("pass-mark " + text + " --novices " + ids + " --experts " + ids, "'a' is a novice as well");
  refused("--log x --scenario y --learner 'Ada Lovelace'", "not an id");
  ResultsDatabase::open_or_make(folder.path / "lab.db");
  refused("report " + (folder.path / "lab.db").string() + " --attempt 3", "no attempt 3");
  const std::string lab = (folder.path / "lab.db").string();
  refused("report " + lab + " --home-page lab", "not a web address");
  refused("comment " + lab, "--attempt or --remove is required");
  refused("comment " + lab + " --attempt 3", "--text is required");
  refused("comment " + lab + " --attempt 3 --text x", "no attempt 3");
  refused("comment " + lab + " --attempt 3 --text \"$(printf 'two\\nlines')\"",
          "command line: comment: character 4 of the comment is a line break; write one paragraph");
  refused("comment " + lab + " --attempt 3 --text x --author 'Ada Lovelace'", "not an id");
  refused("comment " + lab + " --remove 3", "no comment 3");
  refused("comment " + lab + " --remove 3 --text x", "excludes");
  refused("comment " + text + " --attempt 3 --text x", "not a database of results");
  refused("export " + lab, "--out is required");
  refused("export " + lab + " --out " + text, "name a folder that is new");
  refused("export " + text + " --out " + (folder.path / "tables").string(), "not a database of results");
}
