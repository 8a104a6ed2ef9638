#include "scenarios/results/export/score_csv.h"

#include "scenarios/results/export/csv.h"
#include "scenarios/results/measured.h"

namespace insonate {

std::string score_csv_head() {
  return "attempt,uuid,learner,finished,mode,exam,exam_digest,seed,variant,percent,passed,step,title,metric,unit,value,"
         "full,zero,weight,critical,points,why\r\n";
}

std::string score_csv_rows(const Attempt& attempt, const ExamResult& result) {
  std::string rows;
  const bool kept = attempt.number > 0;
  for (const Measured& m : measured(result)) {
    const auto of_score = [&](double CriterionScore::*field) { return m.mark ? csv::number(m.mark->*field) : ""; };
    rows += csv::row({kept ? std::to_string(attempt.number) : "",
                      attempt.uuid,
                      kept ? csv::text(attempt.learner) : "",
                      kept ? utc_time(attempt.finished_ms) : "",
                      name_of(result.provenance.mode),
                      csv::text(result.title),
                      result.provenance.scenario_digest,
                      std::to_string(result.provenance.seed),
                      csv::text(result.provenance.variant),
                      csv::number(result.percent),
                      result.passed ? "1" : "0",
                      m.step ? std::to_string(*m.step + 1) : "",
                      m.step ? csv::text(result.steps[*m.step].title) : "",
                      std::string(info(m.metric).name),
                      csv::text(info(m.metric).unit),
                      m.value ? csv::number(*m.value) : "",
                      of_score(&CriterionScore::full),
                      of_score(&CriterionScore::zero),
                      of_score(&CriterionScore::weight),
                      m.mark ? (m.mark->critical ? "1" : "0") : "",
                      of_score(&CriterionScore::points),
                      m.mark ? csv::text(m.mark->why) : ""});
  }
  return rows;
}

std::string score_csv(const Attempt& attempt, const ExamResult& result) {
  return score_csv_head() + score_csv_rows(attempt, result);
}

}  // namespace insonate
