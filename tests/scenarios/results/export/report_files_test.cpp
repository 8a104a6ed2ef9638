#include "scenarios/results/export/report_files.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <map>
#include <sstream>

#include "scenarios/results/database/results_database.h"
#include "scenarios/results/export/score_csv.h"
#include "scenarios/results/export/xapi.h"
#include "scenarios/results/measured.h"
#include "sim/files/files.h"
#include "tests/scenarios/results/csv_cells.h"
#include "tests/scenarios/results/made_attempt.h"

using namespace insonate;
using Json = nlohmann::json;

namespace {

Attempt kept_attempt(const TinyExam& exam) {
  Attempt attempt = made_attempt("L-07", exam);
  attempt.number = 12;
  attempt.database = std::string(32, 'd');
  attempt.uuid = "0123abcd-4567-4abc-8def-0123456789ff";
  return attempt;
}

}  // namespace

TEST_CASE("reports out of the database equal those made at the end of the exam") {
  const ResultsFolder folder;
  Attempt attempt = made_attempt("L-07", tiny_exam(0));
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  database.add(attempt);
  const ResultFiles first = write_report_files(folder / "first", attempt);
  const ResultFiles again = write_report_files(folder / "again", database.read(1));
  REQUIRE(first.all().size() == 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(read_file(first.all()[i]) == read_file(again.all()[i]));
  CHECK(read_file(first.report).find("L-07") != std::string::npos);
}

TEST_CASE("a report shows the comments on its attempt, and the score lists them and is else the same") {
  const ResultsFolder folder;
  Attempt attempt = made_attempt("L-07", tiny_exam(1.0 / 3));
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  database.add(attempt);
  const ResultFiles before = write_report_files(folder / "before", database.read(1));
  CHECK(read_file(before.report).find("Comments") == std::string::npos);
  Comment comment;
  comment.attempt = 1;
  comment.author = "T-02";
  comment.written_ms = 1'795'284'309'250;
  comment.text = "<b>Slower</b> over the \"ribs\" \u2013 good hold";
  database.add(comment);
  Comment nameless = comment;
  nameless.author.clear();
  nameless.text = "Again";
  database.add(nameless);
  const ResultFiles after = write_report_files(folder / "after", database.read(1));
  const std::string page = read_file(after.report);
  CHECK(page.find("<p>&lt;b&gt;Slower&lt;/b&gt; over the &quot;ribs&quot; \u2013 good hold"
                  "<small>T-02, 2026-11-21 18:05 UTC</small></p>") != std::string::npos);
  CHECK(page.find("<p>Again<small>2026-11-21 18:05 UTC</small></p>") != std::string::npos);

  const std::string score = read_file(after.score);
  Json json = Json::parse(score);
  CHECK(json.at("comments").size() == 2);
  CHECK(json.at("comments")[0] ==
        Json{{"comment", 1}, {"author", "T-02"}, {"written", "2026-11-21T18:05:09.250Z"}, {"text", comment.text}});
  json.erase("comments");
  CHECK(json == Json::parse(attempt.score_json));
  CHECK(to_json(result_from_json(score, "score")) == attempt.score_json);
  const std::string same = attempt.score_json.substr(0, attempt.score_json.rfind('}') - 1);
  CHECK(score.starts_with(same));
  CHECK(read_file(after.table) == read_file(before.table));
  CHECK(read_file(after.statements) == read_file(before.statements));
}

TEST_CASE("each attempt has a folder of its own that stays the same in a database, and the folders sort by time") {
  const ResultsFolder folder;
  Attempt attempt = made_attempt("L-07", tiny_exam(0));
  attempt.scenario_file = "/lab/exams/aorta.toml";
  attempt.finished_ms = 1'795'284'309'250;
  const auto written = [&] {
    const std::filesystem::path own = attempt_folder(folder / "out", attempt);
    write_report_files(own, attempt);
    return own;
  };
  const auto first = written(), at_once = written();
  attempt.finished_ms += 1000;
  const auto later = written();
  CHECK(first == folder / "out/attempts/2026-11-21T18-05-09Z_aorta");
  CHECK(at_once == folder / "out/attempts/2026-11-21T18-05-09Z_aorta-2");
  CHECK(later > at_once);
  attempt.number = 12;
  const std::filesystem::path of_a_database = folder / "out/attempts/2026-11-21T18-05-10Z_aorta_12";
  std::filesystem::create_directories(of_a_database);
  CHECK(attempt_folder(folder / "out", attempt) == of_a_database);
}

TEST_CASE("an attempt in no database has no statements, and removes those of another") {
  const ResultsFolder folder;
  write_report_files(folder / "out", kept_attempt(tiny_exam(0)));
  REQUIRE(std::filesystem::exists(folder / "out/xapi.json"));
  const ResultFiles files = write_report_files(folder / "out", made_attempt("L-07", tiny_exam(0)));
  CHECK(files.all().size() == 3);
  CHECK_FALSE(std::filesystem::exists(folder / "out/xapi.json"));
}

TEST_CASE("the table has a row for each metric, and its numbers are the result's") {
  TinyExam exam = tiny_exam(1.0 / 3);
  exam.result.provenance.mode = AttemptMode::practice;
  const auto rows = cells_of(score_csv(kept_attempt(exam), exam.result));
  const std::vector<std::string>& head = rows.front();
  CHECK(rows.size() == 1 + measured(exam.result).size());
  std::map<std::string, std::map<std::string, std::string>> found;  // by step and metric
  for (std::size_t r = 1; r < rows.size(); ++r) {
    REQUIRE(rows[r].size() == head.size());
    std::map<std::string, std::string> row;
    for (std::size_t c = 0; c < head.size(); ++c) row[head[c]] = rows[r][c];
    CHECK(row["attempt"] == "12");
    CHECK(row["learner"] == "L-07");
    CHECK(row["mode"] == "practice");
    CHECK(row["seed"] == std::to_string(exam.result.provenance.seed));
    CHECK(row["variant"] == exam.result.provenance.variant);
    CHECK(std::stod(row["percent"]) == exam.result.percent);
    CHECK(found.emplace(row["step"] + " " + row["metric"], row).second);
  }
  const CriterionScore& mark = exam.result.steps[0].criteria[0];
  auto& marked = found.at("1 plane_distance_mm");
  CHECK(std::stod(marked["value"]) == *mark.value);
  CHECK(std::stod(marked["points"]) == mark.points);
  CHECK(marked["full"] == "2");
  CHECK(marked["critical"] == "0");
  CHECK(marked["why"] == mark.why);
  auto& unmarked = found.at("2 tilt_deg");
  CHECK(std::stod(unmarked["value"]) == exam.result.steps[1].judged->tilt_deg);
  CHECK(unmarked["weight"].empty());
  CHECK(std::stod(found.at(" path_length_mm")["value"]) == exam.result.motion.path_length_mm);
}

TEST_CASE("text in the table is text to a spreadsheet") {
  TinyExam exam = tiny_exam(0);
  exam.result.title = "=HYPERLINK(\"http://x\")";
  exam.result.steps[0].title = "a \"b\", c";
  const auto rows = cells_of(score_csv(kept_attempt(exam), exam.result));
  CHECK(rows[1][5] == "'=HYPERLINK(\"http://x\")");
  CHECK(rows[1][12] == "a \"b\", c");
}

TEST_CASE("statements inform a learning record store of an attempt") {
  TinyExam good = tiny_exam(0);
  good.result.provenance.mode = AttemptMode::exam;
  const Attempt attempt = kept_attempt(good);
  const std::string text = xapi_statements(attempt, good.result, "");
  CHECK(text == xapi_statements(attempt, good.result, ""));
  CHECK(text.find("mbox") == std::string::npos);
  const Json statements = Json::parse(text);
  REQUIRE(statements.size() == 4);
  std::vector<std::string> verbs, ids;
  for (const Json& statement : statements) {
    verbs.push_back(statement.at("verb").at("id"));
    ids.push_back(statement.at("id"));
    CHECK(statement.at("version") == "1.0.3");
    CHECK(statement.at("actor").at("account").at("name") == "L-07");
    CHECK(statement.at("actor").at("account").at("homePage") ==
          "https://insonate.invalid/databases/" + std::string(32, 'd'));
    CHECK(statement.at("context").at("registration") == attempt.uuid);
    CHECK(statement.at("context").at("extensions").at("https://insonate.invalid/extensions/mode") == "exam");
    CHECK(statement.at("object").at("definition").at("name").at("en") == "Find the ball");
  }
  const std::string adl = "http://adlnet.gov/expapi/verbs/";
  CHECK(verbs == std::vector<std::string>{adl + "initialized", adl + "attempted", adl + "completed", adl + "passed"});
  CHECK(ids[0] == "0123abcd-4567-4abc-8def-012345678900");
  CHECK(ids[3] == "0123abcd-4567-4abc-8def-012345678903");

  CHECK(statements[3].at("timestamp") == "2026-11-21T18:05:09.250Z");
  CHECK(statements[0].at("timestamp") ==
        utc_time(attempt.finished_ms - std::llround(1000 * good.result.motion.time_s)));
  const Json& result = statements[3].at("result");
  CHECK(result.at("success") == true);
  CHECK(result.at("completion") == true);
  CHECK(result.at("score").at("scaled") == good.result.percent / 100);
  CHECK(result.at("score").at("raw") == good.result.points);
  CHECK(result.at("score").at("min") == 0);
  CHECK(result.at("score").at("max") == good.result.points_possible);
  const std::string duration = result.at("duration");
  REQUIRE(duration.starts_with("PT"));
  REQUIRE(duration.ends_with("S"));
  CHECK(std::stod(duration.substr(2)) == Approx(good.result.motion.time_s).margin(0.005));  // hundredths
  const Json& metrics = result.at("extensions").at("https://insonate.invalid/extensions/metrics");
  CHECK(metrics.at("path_length_mm") == good.result.motion.path_length_mm);
  CHECK(result.at("extensions")
            .at("https://insonate.invalid/extensions/steps")[0]
            .at("metrics")
            .at("plane_distance_mm") == *good.result.steps[0].criteria[0].value);
}

TEST_CASE("of practice and recordings statements hold the score, and neither pass nor failure") {
  for (const AttemptMode mode : {AttemptMode::practice, AttemptMode::recording}) {
    TinyExam exam = tiny_exam(0);
    exam.result.provenance.mode = mode;
    const Json statements = Json::parse(xapi_statements(kept_attempt(exam), exam.result, ""));
    REQUIRE(statements.size() == 3);
    CHECK(statements[2].at("verb").at("id") == "http://adlnet.gov/expapi/verbs/completed");
    CHECK(statements[2].at("result").at("score").at("raw") == exam.result.points);
    CHECK_FALSE(statements[2].at("result").contains("success"));
  }
}

TEST_CASE("statements say failed of a failed exam, and judge none that is not complete") {
  const TinyExam poor = tiny_exam(70);
  Json statements = Json::parse(xapi_statements(kept_attempt(poor), poor.result, "https://lab.example/learners"));
  CHECK(statements[3].at("verb").at("display").at("en") == "failed");
  CHECK(statements[3].at("result").at("success") == false);
  CHECK(statements[0].at("actor").at("account").at("homePage") == "https://lab.example/learners");
  ExamResult open = poor.result;
  open.complete = false;
  CHECK(Json::parse(xapi_statements(kept_attempt(poor), open, "")).size() == 2);
}
