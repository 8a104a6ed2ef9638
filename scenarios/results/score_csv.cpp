#include "scenarios/results/score_csv.h"

#include <charconv>
#include <initializer_list>
#include <string_view>

#include "scenarios/results/measured.h"

namespace insonate {
namespace {

std::string number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string as_cell(std::string_view text) {
  std::string cell = "\"";
  if (!text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos) cell += '\'';
  for (const char c : text) cell.append(c == '"' ? 2 : 1, c);
  return cell + '"';
}

std::string row(std::initializer_list<std::string> cells) {
  std::string line;
  for (const std::string& cell : cells) line.append(cell).append(",");
  line.pop_back();
  return line + "\r\n";
}

}  // namespace

std::string score_csv(const Attempt& attempt, const ExamResult& result) {
  std::string csv =
      "attempt,uuid,learner,finished,mode,exam,exam_digest,seed,variant,percent,passed,step,title,metric,unit,value,"
      "full,zero,weight,critical,points,why\r\n";
  const bool kept = attempt.number > 0;
  for (const Measured& m : measured(result)) {
    const auto of_score = [&](double CriterionScore::*field) { return m.mark ? number(m.mark->*field) : ""; };
    csv += row({kept ? std::to_string(attempt.number) : "",
                attempt.uuid,
                kept ? as_cell(attempt.learner) : "",
                kept ? utc_time(attempt.finished_ms) : "",
                name_of(result.provenance.mode),
                as_cell(result.title),
                result.provenance.scenario_digest,
                std::to_string(result.provenance.seed),
                as_cell(result.provenance.variant),
                number(result.percent),
                result.passed ? "1" : "0",
                m.step ? std::to_string(*m.step + 1) : "",
                m.step ? as_cell(result.steps[*m.step].title) : "",
                std::string(info(m.metric).name),
                as_cell(info(m.metric).unit),
                m.value ? number(*m.value) : "",
                of_score(&CriterionScore::full),
                of_score(&CriterionScore::zero),
                of_score(&CriterionScore::weight),
                m.mark ? (m.mark->critical ? "1" : "0") : "",
                of_score(&CriterionScore::points),
                m.mark ? as_cell(m.mark->why) : ""});
  }
  return csv;
}

}  // namespace insonate
