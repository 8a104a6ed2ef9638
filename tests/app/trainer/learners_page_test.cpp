#include "app/trainer/learners_page.h"

#include <catch2/catch.hpp>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "tests/scenarios/results/made_attempt.h"

using namespace insonate;

namespace {

/// Adds an attempt with this score to a database, that many minutes after the others.
std::int64_t add(ResultsDatabase& database, const std::string& learner, AttemptMode mode, double percent, int minute,
                 const std::string& scenario = "exam") {
  ExamResult result;
  result.title = "The " + scenario.substr(0, scenario.find(' '));
  result.provenance.mode = mode;
  result.percent = percent;
  result.pass_mark_percent = 70;
  result.passed = percent >= 70;
  result.motion.time_s = 60 + minute;
  StepResult& step = result.steps.emplace_back();
  step.title = "Liver";
  step.outcome = StepOutcome::held;
  CriterionScore score;
  score.metric = Metric::plane_distance_mm;
  score.weight = 4;
  score.points = percent / 25;
  step.criteria.push_back(score);
  Attempt attempt;
  attempt.learner = learner;
  attempt.finished_ms = 1'795'284'309'250 + minute * 60'000;
  attempt.scenario_text = scenario;
  attempt.scenario_file = "/exams/exam.toml";
  attempt.score_json = to_json(result);
  attempt.trace_json = to_json(std::vector<TracePoint>());
  database.add(attempt);
  return attempt.number;
}

void read_all(LearnersPage& page) {
  while (page.reading() > 0) page.update();
}

std::vector<std::int64_t> numbers(const LearnersPage& page) {
  std::vector<std::int64_t> list;
  for (const AttemptSummary& attempt : page.attempts()) list.push_back(attempt.number);
  return list;
}

}  // namespace

TEST_CASE("the page of learners has a line for all and one for each, with best, last, and exams passed") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  add(database, "L-02", AttemptMode::practice, 90, 1);
  add(database, "L-02", AttemptMode::exam, 60, 3);
  add(database, "L-02", AttemptMode::exam, 80, 2, "other");
  add(database, "L-01", AttemptMode::practice, 40, 0);

  const LearnersPage page(folder / "results.db");
  REQUIRE(page.learners().size() == 3);
  const LearnerLine &all = page.learners()[0], &second = page.learners()[2];
  CHECK(all.id.empty());
  CHECK(all.attempts == 4);
  CHECK(page.learners()[1].id == "L-01");
  CHECK(page.learners()[1].exams == 0);
  CHECK(page.learners()[1].best_percent == std::map<AttemptMode, double>{{AttemptMode::practice, 40}});
  CHECK(second.id == "L-02");
  CHECK(second.attempts == 3);
  CHECK(second.exams == 2);
  CHECK(second.passed_exams == 1);
  CHECK(second.best_percent == std::map<AttemptMode, double>{{AttemptMode::exam, 80}, {AttemptMode::practice, 90}});
  CHECK(second.last_ms == 1'795'284'309'250 + 3 * 60'000);
}

TEST_CASE("a learner's attempts are there newest first, with the trend of a scenario and of its criteria") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  add(database, "L-01", AttemptMode::practice, 25, 0);
  add(database, "L-02", AttemptMode::practice, 99, 1);
  add(database, "L-01", AttemptMode::practice, 50, 2);
  add(database, "L-01", AttemptMode::exam, 75, 4);
  add(database, "L-01", AttemptMode::recording, 10, 3, "other");

  LearnersPage page(folder / "results.db");
  page.choose_learner("L-01");
  CHECK(numbers(page) == std::vector<std::int64_t>{4, 5, 3, 1});
  CHECK(page.choice().attempt == 4);
  REQUIRE(page.scenarios().size() == 2);
  CHECK(page.scenarios()[0].title == "The exam");
  CHECK(page.scenarios()[0].attempts == 3);
  CHECK(page.modes() == std::vector<AttemptMode>{AttemptMode::exam, AttemptMode::practice, AttemptMode::recording});

  CHECK(page.reading() == 4);
  CHECK(page.trend().unread == 3);
  CHECK(page.trend().criteria.empty());
  CHECK_FALSE(page.time_s(4));
  read_all(page);
  CHECK(page.time_s(4) == 64);
  const ScoreTrend& trend = page.trend();
  CHECK(trend.title == "The exam");
  CHECK(trend.attempts == 3);
  REQUIRE(trend.points.size() == 3);
  CHECK(trend.points[0].attempt == 1);
  CHECK(trend.points[0].percent == 25);
  CHECK_FALSE(trend.points[0].passed);
  CHECK(trend.points[2].ordinal == 2);
  CHECK(trend.points[2].mode == AttemptMode::exam);
  CHECK(trend.points[2].passed);
  CHECK(trend.pass_mark_percent == 70);
  CHECK(trend.spreads.empty());
  REQUIRE(trend.criteria.size() == 1);
  CHECK(trend.criteria[0].shares == std::vector<std::optional<double>>{0.25, 0.5, 0.75});

  INFO("a scenario brings its newest attempt");
  page.choose_scenario(page.scenarios()[1].digest);
  CHECK(page.choice().attempt == 5);
  page.choose_scenario(page.scenarios()[0].digest);
  CHECK(page.choice().attempt == 4);
  page.choose_attempt(3);
  page.choose_scenario(page.scenarios()[0].digest);
  CHECK(page.choice().attempt == 3);

  INFO("an attempt brings its scenario, a mode leaves the others out, and what is chosen stays if it can");
  page.choose_attempt(5);
  CHECK(page.trend().title == "The other");
  page.choose_mode(AttemptMode::practice);
  CHECK(numbers(page) == std::vector<std::int64_t>{3, 1});
  CHECK(page.choice().attempt == 3);
  CHECK(page.trend().title == "The exam");
  page.choose_attempt(1);
  page.choose_mode(std::nullopt);
  CHECK(page.choice().attempt == 1);
  page.choose_mode(AttemptMode::exam);
  page.choose_learner("L-02");
  CHECK_FALSE(page.choice().mode);  // there is no exam
  CHECK(numbers(page) == std::vector<std::int64_t>{2});

  INFO("keys move through the list, to its ends");
  page.move_choice(-5);
  CHECK(page.choice().learner.empty());
  page.move_choice(+1);
  CHECK(page.choice().learner == "L-01");
  page.move_choice(+9);
  CHECK(page.choice().learner == "L-02");
}

TEST_CASE("a group has quartiles where a handful of learners have a score of one mode") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  for (int i = 0; i < 5; ++i) {
    add(database, "L-0" + std::to_string(i), AttemptMode::practice, 10 * (i + 1), i);
    if (i < 4) add(database, "L-0" + std::to_string(i), AttemptMode::practice, 90, 10 + i);
  }
  LearnersPage page(folder / "results.db");
  REQUIRE(page.trend().spreads.size() == 1);  // four at the second attempt are not a handful
  CHECK(page.trend().spreads[0].ordinal == 0);
  CHECK(page.trend().spreads[0].learners == 5);
  CHECK(page.trend().spreads[0].percent.first_quartile == 20);
  CHECK(page.trend().spreads[0].percent.median == 30);
  CHECK(page.trend().spreads[0].percent.third_quartile == 40);
  CHECK(page.trend().attempts == 2);
  read_all(page);
  CHECK(page.trend().criteria[0].shares[0] == Approx(0.3));

  add(database, "L-09", AttemptMode::exam, 100, 30);
  LearnersPage mixed(folder / "results.db");
  CHECK(mixed.trend().mixes_modes);
  CHECK(mixed.trend().spreads.empty());
  mixed.choose_mode(AttemptMode::practice);
  CHECK_FALSE(mixed.trend().mixes_modes);
  CHECK(mixed.trend().spreads.size() == 1);
}

TEST_CASE("two texts of one title are two scenarios, and can be distinguished") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  add(database, "L-01", AttemptMode::practice, 40, 0, "exam 1");
  add(database, "L-01", AttemptMode::practice, 40, 1, "exam 2");
  const LearnersPage page(folder / "results.db");
  REQUIRE(page.scenarios().size() == 2);
  CHECK(page.scenarios()[0].title == "The exam (" + page.scenarios()[0].digest.substr(0, 6) + ")");
  CHECK(page.scenarios()[0].title != page.scenarios()[1].title);
  CHECK(page.trend().points.size() == 1);
}

TEST_CASE("comments are added to the chosen attempt and removed, and reports and tables are written") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  add(database, "L-01", AttemptMode::practice, 40, 0);
  add(database, "L-01", AttemptMode::practice, 50, 1);
  LearnersPage page(folder / "results.db");
  page.choose_attempt(1);
  CHECK(page.comments().empty());
  page.choose_author("T-02");
  CHECK_THROWS_WITH(page.choose_author("Ada Lovelace"), Catch::Contains("not an id"));
  const std::int64_t before_ms = now_since_1970_ms();
  page.add_comment("Slow down");
  CHECK_THROWS_WITH(page.add_comment("two\nlines"), Catch::Contains("line break"));
  REQUIRE(page.comments().size() == 1);
  CHECK(page.comments()[0].author == "T-02");
  CHECK(page.comments()[0].written_ms >= before_ms);
  CHECK(page.comments_on(1) == 1);
  CHECK(page.comments_on(2) == 0);
  CHECK(database.comments(1).size() == 1);
  page.choose_attempt(2);
  CHECK(page.comments().empty());
  page.choose_attempt(1);
  CHECK(page.comments().size() == 1);

  const auto report = page.write_report(folder / "out");
  CHECK(report == folder / "out/attempts/2026-11-21T18-05-09Z_exam_1/report.html");
  CHECK(page.write_report(folder / "out") == report);
  CHECK(read_file(report).find("Slow down<small>T-02, ") != std::string::npos);
  const auto tables = page.export_tables(folder / "out"), again = page.export_tables(folder / "out");
  CHECK(tables.parent_path() == folder / "out/tables");
  CHECK(again != tables);
  CHECK(read_file(tables / "comments.csv") == read_file(again / "comments.csv"));

  page.remove_comment(1);
  CHECK(page.comments().empty());
  CHECK(page.comments_on(1) == 0);
  CHECK(database.comments().empty());

  INFO("a later page continues where this one was");
  LearnersChoice choice = page.choice();
  const LearnersPage later(folder / "results.db", choice);
  CHECK(later.choice().attempt == 1);
  CHECK(later.choice().author == "T-02");
  choice.learner = "L-77";  // who has been removed meanwhile
  CHECK(LearnersPage(folder / "results.db", choice).choice().learner.empty());
}

TEST_CASE("a score that cannot be read is a problem to be seen, and the others are shown") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  add(database, "L-01", AttemptMode::practice, 40, 0);
  add(database, "L-01", AttemptMode::practice, 50, 1);
  sqlite::Connection(folder / "results.db", false).run("UPDATE attempt SET score = '{}' WHERE number = 1");
  LearnersPage page(folder / "results.db");
  read_all(page);
  CHECK(page.problem().find("results.db: attempt 1: ") != std::string::npos);
  CHECK(page.trend().points.size() == 2);
  CHECK(page.trend().criteria.size() == 1);
  CHECK_FALSE(page.time_s(1));
  CHECK(page.time_s(2));
  CHECK_THROWS_WITH(page.export_tables(folder / "out"), Catch::Contains("an attempt lacks its criteria"));
}

TEST_CASE("a database without attempts has a page") {
  const ResultsFolder folder;
  ResultsDatabase::open_or_make(folder / "results.db");
  LearnersPage page(folder / "results.db");
  CHECK(page.learners().size() == 1);
  CHECK(page.attempts().empty());
  CHECK(page.attempt() == nullptr);
  CHECK(page.reading() == 0);
  page.move_choice(1);
  page.choose_scenario("x");
  page.update();
  CHECK(page.trend().points.empty());
  CHECK_THROWS_AS(LearnersPage(folder / "none.db"), InputError);
}
