#include <catch2/catch.hpp>

#include "scenarios/criterion_score.h"
#include "scenarios/report/report.h"
#include "scenarios/result_json.h"
#include "scenarios/runner.h"
#include "scenarios/words.h"
#include "sim/core/input_error.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

struct Scan {
  ExamResult result;
  std::vector<TracePoint> trace;
};

Scan scan(double offset_mm, const std::string& scenario_text = kTinyScenario) {
  const Case subject = tiny_case();
  Runner runner(parse_scenario(scenario_text, "exam.toml"), subject, tiny_tissues());
  auto samples = samples_of(25, 30, [&](double t) {
    return turned(1.0 / 3 * t, {1, 0, 0}, {0, 0, offset_mm + 10 * std::exp(-t)});
  });
  for (ProbeSample& sample : samples)
    if (sample.time_s > 0.5 && sample.time_s < 0.9) sample.status = PoseStatus::missing;
  runner.feed(samples);
  runner.end();
  return {runner.result(), runner.trace()};
}

int count(const std::string& text, const std::string& what) {
  int found = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

}  // namespace

TEST_CASE("a result goes to JSON and back without losing a bit") {
  for (const double offset : {1.0 / 3, 70.0}) {
    ExamResult result = scan(offset).result;
    result.provenance.log = "a \"quoted\" n\u00e4me.igs.mha";
    result.provenance.phantom_options = {{"free_fluid", "true"}};
    const std::string json = to_json(result);
    const ExamResult back = result_from_json(json, "result.json");
    CHECK(to_json(back) == json);
    CHECK(back.percent == result.percent);
    CHECK(back.motion.path_length_mm == result.motion.path_length_mm);
    CHECK(back.reasons == result.reasons);
    CHECK(back.steps[0].judged->tilt_deg == result.steps[0].judged->tilt_deg);
    CHECK(back.steps[0].criteria[0].value == result.steps[0].criteria[0].value);
  }
}

TEST_CASE("a result keeps how it came about, and one that does not say reads as before") {
  ExamResult result = scan(1).result;
  CHECK(to_json(result).find("\"mode\"") == std::string::npos);
  CHECK(result_from_json(to_json(result), "x").provenance.mode == std::nullopt);
  for (const auto& [mode, words] : {std::pair{AttemptMode::exam, "report of an exam<"},
                                    {AttemptMode::practice, "report of practice, which does not count as an exam<"},
                                    {AttemptMode::recording, "report of a recorded scan<"}}) {
    result.provenance.mode = mode;
    CHECK(result_from_json(to_json(result), "x").provenance.mode == mode);
    CHECK(report_html(result, {}).find(words) != std::string::npos);
  }
  std::string other = to_json(result);
  other.replace(other.find("\"recording\""), 11, "\"cramming\"");
  CHECK_THROWS_AS(result_from_json(other, "x"), InputError);
  for (const double never : {-1.0, 1e30}) {  // milliseconds since 1970 could not hold its beginning
    result.motion.time_s = never;
    CHECK_THROWS_WITH(result_from_json(to_json(result), "x"), Catch::Contains("not a result of Insonate: a scan of"));
  }
}

TEST_CASE("a result of another scoring version reads, and says so") {
  ExamResult result = scan(1).result;
  CHECK(result.provenance.scoring_version == ExamResult::kScoringVersion);
  result.provenance.scoring_version = 99;
  CHECK(result_from_json(to_json(result), "x").provenance.scoring_version == 99);
  CHECK(report_html(result, {}).find("scoring 99") != std::string::npos);
}

TEST_CASE("JSON that is not a result is refused") {
  const std::string json = to_json(scan(1).result);
  CHECK_THROWS_AS(result_from_json("", "x"), InputError);
  CHECK_THROWS_AS(result_from_json("{}", "x"), InputError);
  CHECK_THROWS_AS(result_from_json(json.substr(0, json.size() / 2), "x"), InputError);
  const auto spoiled = [&](const std::string& from, const std::string& to) {
    std::string text = json;
    REQUIRE(text.find(from) != std::string::npos);
    text.replace(text.find(from), from.size(), to);
    CHECK_THROWS_AS(result_from_json(text, "x"), InputError);
  };
  spoiled("\"format\": 2", "\"format\": 3");
  spoiled("\"scoring_version\": " + std::to_string(ExamResult::kScoringVersion), "\"scoring_version\": \"2\"");
  for (const char* version : {"4.5", "-1e300", "4294967296"})
    spoiled("\"scoring_version\": " + std::to_string(ExamResult::kScoringVersion),
            "\"scoring_version\": " + std::string(version));
  spoiled("\"plane_distance_mm\",", "\"plane_distance_km\",");
  spoiled("\"held\"", "\"dropped\"");
  spoiled("\"percent\": ", "\"percent\": \"\", \"x\": ");
}

/// Returns the page with blanks at which a line may break.
std::string breakable(std::string html) {
  for (std::size_t at = 0; (at = html.find("\u00a0", at)) != std::string::npos;) html.replace(at, 2, " ");
  return html;
}

TEST_CASE("no line of the report breaks between a number and its unit") {
  const Scan one = scan(70);
  const std::string html = report_html(one.result, one.trace);
  const std::string& why = one.result.steps[0].criteria[0].why;
  const std::size_t blank = why.find(" mm");
  REQUIRE(blank != std::string::npos);
  CHECK(html.find(why.substr(0, blank) + "\u00a0mm") != std::string::npos);
}

TEST_CASE("the report names the verdict, its reasons, and each criterion with value, limits, points and why") {
  for (const double offset : {0.0, 70.0}) {
    const Scan one = scan(offset);
    const std::string html = breakable(report_html(one.result, one.trace));
    CHECK(html.find(one.result.passed ? ">Passed<" : ">Not passed<") != std::string::npos);
    for (const std::string& reason : one.result.reasons) CHECK(html.find(reason) != std::string::npos);
    for (const StepResult& step : one.result.steps)
      for (const CriterionScore& m : step.criteria) {
        CHECK(html.find(title_of(m.metric)) != std::string::npos);
        CHECK(html.find(m.why) != std::string::npos);
      }
    CHECK(count(html, "<tr class='") == 4);
    CHECK(count(html, "class='critical'") == 1);
    CHECK(html.find("exam.toml") != std::string::npos);
    CHECK(html.find(one.result.provenance.case_digest) != std::string::npos);
    CHECK(html.find("nan") == std::string::npos);
  }
  CHECK(scan(0).result.passed);
  CHECK_FALSE(scan(70).result.passed);
}

TEST_CASE("a step that was ended early has the same points in each place, and the words for them") {
  StepResult step;
  step.title = "Early";
  step.outcome = StepOutcome::went_on;
  step.criteria = {{Metric::plane_distance_mm, 5, 20, 2, false, 1.0, 2, "1.0 mm: full points."},
                   {Metric::longest_hold_s, 1, 0, 1, false, 0.0, 0, "0.00 s: nothing."}};
  CHECK(score_in_words(step) == "2 of 3 points for what was reached");
  step.hints_taken = 1;
  step.hint_cost = 0.5;
  CHECK(score_in_words(step) == "1.5 of 3 points for what was reached");
  ExamResult result;
  StepResult warm_up = step;
  warm_up.counts = false;
  result.steps = {step, warm_up};
  decide(result);
  CHECK(result.points == 1.5);
  const std::string html = report_html(result, {});
  const std::string overview = html.substr(html.find("class='overview'"));
  CHECK(overview.find("1.5 of 3 points for what was reached") < overview.find("2. Early"));
  CHECK(overview.find("does not count") > overview.find("2. Early"));
  CHECK(html.find("ended early by the learner") != std::string::npos);

  for (StepResult& done : result.steps) done.outcome = StepOutcome::done;
  CHECK(score_in_words(result.steps[0]) == "1.5 of 3 points");
  CHECK(score_in_words(result.steps[1]) == "does not count");
}

TEST_CASE("the report draws the scan over time and in space, and needs no other file") {
  const Scan one = scan(0);
  const std::string html = report_html(one.result, one.trace);
  CHECK(count(html, "<svg") == 3);
  CHECK(count(html, "class='curve'") == 4);
  CHECK(count(html, "class='held'") == 4 * 2);
  CHECK(count(html, "class='lost'") >= 4);
  CHECK(html.find("http") == std::string::npos);
  CHECK(html.find("src=") == std::string::npos);
  CHECK(report_html(one.result, one.trace) == html);

  CHECK(count(report_html(one.result, {}), "<svg") == 0);

  // Where a step compares with no view, three of the curves have nothing to show: they do not fall to 0.
  const auto first_curve = [](const std::string& page) {
    const std::size_t at = page.find("class='curve' d='") + 17;
    return page.substr(at, page.find('\'', at) - at);
  };
  CHECK_FALSE(first_curve(html).empty());
  Scan without = scan(0);
  for (StepResult& step : without.result.steps) step.view.clear();
  CHECK(first_curve(report_html(without.result, without.trace)).empty());
}

TEST_CASE("the report shows the best picture of a step beside its reference view, and says whose attempt it was") {
  const Scan one = scan(0);
  ReportSubject subject;
  subject.learner = "L-07";
  subject.attempt = "12";
  subject.finished = "2026-11-21";
  subject.pictures = {{1, ReportPicture::Kind::reference, "ref"}};
  std::string html = report_html(one.result, one.trace, subject);
  CHECK(count(html, "<figure>") == 2);
  CHECK(html.find("The view was not held") < html.find("data:image/png;base64,cmVm'"));
  CHECK(html.find("held best") == std::string::npos);  // there is no such picture
  CHECK(html.find("class='missing'") > html.find("2. Ball again</td>"));
  for (const char* text : {">L-07<", ">12<", ">2026-11-21<"}) CHECK(html.find(text) != std::string::npos);

  subject.pictures.push_back({1, ReportPicture::Kind::best, "best1"});
  html = report_html(one.result, one.trace, subject);
  CHECK(html.find("base64,YmVzdDE='") < html.find("base64,cmVm'"));
  CHECK(html.find("While the view was held best") != std::string::npos);
  ExamResult early = one.result;
  early.steps[1].outcome = StepOutcome::went_on;
  CHECK(report_html(early, one.trace, subject).find("held best") == std::string::npos);
  CHECK(count(html, "class='missing'") == 0);

  subject.pictures = {{1, ReportPicture::Kind::best, "best1"}};  // as of a step without a reference view
  html = report_html(one.result, one.trace, subject);
  CHECK(count(html, "<figure>") == 1);
  CHECK(html.find("Reference view") == std::string::npos);
}

TEST_CASE("text from a scenario stays text in the report") {
  std::string text = kTinyScenario;
  text.replace(text.find("Find the ball"), 13, "<script>alert('x')</script> & co");
  const Scan one = scan(0, text);
  const std::string html = report_html(one.result, one.trace);
  CHECK(html.find("<script>alert") == std::string::npos);
  CHECK(html.find("&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; co") != std::string::npos);
}
