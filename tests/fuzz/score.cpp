// Scores and traces as attempts keep them, and what is made of them: the same bytes as either.
#include "scenarios/result_json.h"
#include "scenarios/results/export/score_csv.h"
#include "scenarios/results/export/xapi.h"
#include "scenarios/results/trace_json.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

std::string broken_by_score(std::string_view bytes) {
  const ExamResult result = result_from_json(bytes, "score.json");
  const std::string text = to_json(result);
  if (to_json(result_from_json(text, "written again")) != text) return "a score written and read again is another";
  Attempt attempt;
  attempt.number = 1;
  attempt.database = std::string(32, 'a');
  attempt.uuid = "00000000-0000-4000-8000-000000000000";
  attempt.learner = "L-01";
  attempt.score_json = std::string(bytes);
  if (report_html(result, {}).empty() || score_csv(attempt, result).empty() ||
      xapi_statements(attempt, result, "").empty())
    return "nothing is made of a score";
  return "";
}

std::string broken_by_trace(std::string_view bytes) {
  const std::vector<TracePoint> trace = trace_from_json(bytes, "trace.json");
  const std::string text = to_json(trace);
  if (to_json(trace_from_json(text, "written again")) != text) return "a trace written and read again is another";
  ExamResult result;
  result.steps.resize(2);
  return report_html(result, trace).empty() ? "nothing is made of a trace" : "";
}

const Target score_target("score", [](std::string_view bytes) -> std::string {
  const std::string broken = broken_by([&] { return broken_by_score(bytes); });
  return broken.empty() ? broken_by_trace(bytes) : broken;
});

}  // namespace
}  // namespace insonate::fuzz
