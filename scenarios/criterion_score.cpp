#include "scenarios/criterion_score.h"

#include <algorithm>

#include "scenarios/words.h"

namespace insonate {
namespace {

/// Rounding error of summed points, in per cent: eight of ten criteria of 0.1 points each are 80 %.
constexpr double kRounding_percent = 1e-9;

std::string name_of(const StepResult& step, std::size_t index) {
  return "Step " + std::to_string(index + 1) + " (" + step.title + ")";
}

/// Returns why a step was not done, as a sentence; empty if it was done or skipped.
std::string why_not_done(const StepResult& step, std::size_t index) {
  const bool holds = step.holds_view;
  const std::string longest = holds ? " (longest: " + fixed(step.longest_hold_s, 1) + " s)" : "";
  switch (step.outcome) {
    case StepOutcome::held:
    case StepOutcome::done:
      return "";
    case StepOutcome::went_on:
      return name_of(step, index) + ": the learner went on before it was done.";
    case StepOutcome::timed_out:
      return name_of(step, index) +
             (holds ? ": the view was not held long enough before the time ran out" + longest
                    : ": it was not done before the time ran out") +
             ".";
    case StepOutcome::scan_ended:
      return name_of(step, index) + ": the scan ended before " +
             (holds ? "the view was held long enough" + longest : "it was done") + ".";
    case StepOutcome::skipped:
      return "";
    case StepOutcome::not_reached:
      return name_of(step, index) + " was not reached.";
  }
  return "";
}

/// Adds the criteria of one part of the exam that earned nothing: only the critical ones, or only the others.
void add_failed(const std::vector<CriterionScore>& criteria, const std::string& where, bool critical,
                std::vector<std::string>& reasons) {
  for (const CriterionScore& m : criteria)
    if (m.points <= 0 && m.critical == critical)
      reasons.push_back(where + (critical ? ", critical: " : ": ") + std::string(info(m.metric).words) + ", " + m.why);
}

}  // namespace

double StepResult::possible() const {
  double sum = 0;
  for (const CriterionScore& m : criteria) sum += m.weight;
  return counts ? sum : 0;
}

double StepResult::earned() const {
  double sum = 0;
  for (const CriterionScore& m : criteria) sum += m.points;
  return std::max(0.0, sum - hint_cost);
}

double StepResult::lost_to_hints() const {
  double sum = 0;
  for (const CriterionScore& m : criteria) sum += m.points;
  return std::min(hint_cost, sum);
}

CriterionScore score_criterion(const Criterion& criterion, std::optional<double> value,
                               const std::string& why_no_value) {
  CriterionScore m{
      criterion.metric, criterion.full, criterion.zero, criterion.weight, criterion.critical, value, 0, ""};
  if (!value) {
    m.why = why_no_value;
    return m;
  }
  const double share = std::clamp((*value - criterion.zero) / (criterion.full - criterion.zero), 0.0, 1.0);
  m.points = share * criterion.weight;
  const std::string measured = in_words(criterion.metric, *value);
  const std::string full = in_words(criterion.metric, criterion.full);
  const std::string zero = in_words(criterion.metric, criterion.zero);
  const bool less = criterion.full < criterion.zero;
  if (share >= 1)
    m.why = measured + ": full points for " + full + (less ? " or less." : " or more.");
  else if (share <= 0)
    m.why =
        measured + (measured == zero ? ": no points." : ": nothing for " + zero + (less ? " or more." : " or less."));
  else
    m.why = measured + ": between full points at " + full + " and none at " + zero + ".";
  return m;
}

void decide(ExamResult& result) {
  result.points = result.points_possible = 0;
  bool critical_failed = false;
  const auto add = [&](const std::vector<CriterionScore>& criteria) {
    for (const CriterionScore& m : criteria) {
      result.points += m.points;
      result.points_possible += m.weight;
      critical_failed = critical_failed || m.fails_exam();
    }
  };
  for (const StepResult& step : result.steps)
    if (step.counts) add(step.criteria);
  add(result.criteria);
  for (const StepResult& step : result.steps)
    if (step.counts) result.points -= step.lost_to_hints();
  result.percent = result.points_possible > 0 ? 100 * result.points / result.points_possible : 0;
  const bool enough = result.percent >= result.pass_mark_percent - kRounding_percent;
  result.passed = enough && !critical_failed;
  result.reasons.clear();
  if (result.passed) return;

  if (!enough)
    result.reasons.push_back("The score is " + percentage(result) + " %; " + short_number(result.pass_mark_percent) +
                             " % are needed to pass.");
  for (const bool critical : {true, false}) {
    for (std::size_t i = 0; i < result.steps.size(); ++i) {
      const StepResult& step = result.steps[i];
      if (!step.counts || step.outcome == StepOutcome::skipped) continue;
      if (critical && !step.criteria.empty() && !is_done(step.outcome)) result.reasons.push_back(why_not_done(step, i));
      if (step.outcome != StepOutcome::not_reached)
        add_failed(step.criteria, name_of(step, i), critical, result.reasons);
    }
    add_failed(result.criteria, "Whole exam", critical, result.reasons);
  }
}

}  // namespace insonate
