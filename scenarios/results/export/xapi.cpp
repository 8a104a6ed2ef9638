#include "scenarios/results/export/xapi.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "scenarios/results/measured.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

using OrderedJson = nlohmann::ordered_json;

const std::string kOwn = "https://insonate.invalid/";
const std::string kVerbs = "http://adlnet.gov/expapi/verbs/";

/// Returns the attempt's UUID with the last byte changed: equally unique, and the same on every export.
std::string statement_id(const std::string& uuid, int statement) {
  char last[3];
  std::snprintf(last, sizeof last, "%02x", (std::stoi(uuid.substr(34), nullptr, 16) + statement) & 0xff);
  return uuid.substr(0, 34) + last;
}

/// ISO 8601 with hundredths of a second, as the specification requires for a duration.
std::string duration(double seconds) {
  return formatted("PT%.2fS", seconds);
}

/// Returns every metric with a value, by its name, for the exam and for each step.
OrderedJson metrics_of(const ExamResult& result) {
  OrderedJson exam = OrderedJson::object(), steps = OrderedJson::array();
  for (const StepResult& step : result.steps)
    steps.push_back({{"title", step.title}, {"metrics", OrderedJson::object()}});
  for (const Measured& m : measured(result))
    if (m.value) (m.step ? steps[*m.step]["metrics"] : exam)[std::string(info(m.metric).name)] = *m.value;
  return {{kOwn + "extensions/metrics", exam}, {kOwn + "extensions/steps", steps}};
}

OrderedJson score_of(const ExamResult& result) {
  OrderedJson score = {{"scaled", result.percent / 100}};
  // The specification requires max above min, and raw between them.
  if (result.points_possible > 0) score.update({{"raw", result.points}, {"min", 0}, {"max", result.points_possible}});
  return score;
}

}  // namespace

std::string xapi_statements(const Attempt& attempt, const ExamResult& result, const std::string& home_page) {
  const std::string home = home_page.empty() ? kOwn + "databases/" + attempt.database : home_page;
  const OrderedJson actor = {{"objectType", "Agent"}, {"account", {{"homePage", home}, {"name", attempt.learner}}}};
  const OrderedJson object = {
      {"objectType", "Activity"},
      {"id", kOwn + "scenarios/" + result.provenance.scenario_digest},
      {"definition", {{"name", {{"en", result.title}}}, {"type", "http://adlnet.gov/expapi/activities/assessment"}}}};
  OrderedJson extensions = {{kOwn + "extensions/case_digest", result.provenance.case_digest},
                            {kOwn + "extensions/scoring_version", result.provenance.scoring_version}};
  if (result.provenance.mode) extensions[kOwn + "extensions/mode"] = name_of(result.provenance.mode);
  const OrderedJson context = {{"registration", attempt.uuid},
                               {"platform", "Insonate " + result.provenance.program_version},
                               {"language", "en"},
                               {"extensions", extensions}};
  constexpr double kLongest_s = 1e9;  // of what a file of another origin may state, so that the start is a time
  const std::int64_t start_ms =
      attempt.finished_ms - std::llround(1000 * std::clamp(result.motion.time_s, 0.0, kLongest_s));

  OrderedJson statements = OrderedJson::array();
  const auto state = [&](const char* verb, std::int64_t at_ms, const OrderedJson& outcome) {
    OrderedJson statement = {{"id", statement_id(attempt.uuid, int(statements.size()) + 1)},
                             {"version", "1.0.3"},
                             {"actor", actor},
                             {"verb", {{"id", kVerbs + verb}, {"display", {{"en", verb}}}}},
                             {"object", object},
                             {"context", context},
                             {"timestamp", utc_time(at_ms)}};
    if (!outcome.is_null()) statement["result"] = outcome;
    statements.push_back(std::move(statement));
  };
  state("initialized", start_ms, nullptr);
  state("attempted", start_ms, nullptr);
  if (result.complete) {
    const OrderedJson done = {{"completion", true}, {"duration", duration(result.motion.time_s)}};
    OrderedJson judged = {{"score", score_of(result)}};
    judged.update(done);
    judged["extensions"] = metrics_of(result);
    if (is_of(result.provenance.mode, AttemptMode::exam)) {
      state("completed", attempt.finished_ms, done);
      judged["success"] = result.passed;
      state(result.passed ? "passed" : "failed", attempt.finished_ms, judged);
    } else {
      state("completed", attempt.finished_ms, judged);
    }
  }
  return statements.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

}  // namespace insonate
