#include "scenarios/results/measured.h"

#include <algorithm>

namespace insonate {
namespace {

const CriterionScore* find_score(const std::vector<CriterionScore>& criteria, Metric metric) {
  const auto found =
      std::find_if(criteria.begin(), criteria.end(), [&](const CriterionScore& m) { return m.metric == metric; });
  return found == criteria.end() ? nullptr : &*found;
}

std::optional<double> value_of(const StepResult& step, const MetricInfo& metric) {
  switch (metric.scope) {
    case MetricScope::picture:
      return step.judged ? std::optional(step.judged->of(metric.metric)) : std::nullopt;
    case MetricScope::step:
      return step.value(metric.metric);
    case MetricScope::motion:
      return step.motion.of(metric.metric);
  }
  return std::nullopt;
}

void add(std::vector<Measured>& list, std::optional<std::size_t> step, Metric metric, std::optional<double> value,
         const CriterionScore* mark) {
  // A judged metric has the value that was judged.
  if (mark) value = mark->value;
  if (value || mark) list.push_back({step, metric, value, mark});
}

}  // namespace

std::vector<Measured> measured(const ExamResult& result) {
  std::vector<Measured> list;
  for (std::size_t i = 0; i < result.steps.size(); ++i)
    for (const MetricInfo& m : metrics())
      add(list, i, m.metric,
          result.steps[i].outcome == StepOutcome::not_reached ? std::nullopt : value_of(result.steps[i], m),
          find_score(result.steps[i].criteria, m.metric));
  for (const MetricInfo& m : metrics())
    add(list, std::nullopt, m.metric, m.scope == MetricScope::motion ? result.motion.of(m.metric) : std::nullopt,
        find_score(result.criteria, m.metric));
  return list;
}

}  // namespace insonate
