#include "scenarios/results/measured.h"

#include <algorithm>

namespace insonate {
namespace {

const Mark* find_mark(const std::vector<Mark>& marks, Metric metric) {
  const auto found = std::find_if(marks.begin(), marks.end(), [&](const Mark& m) { return m.metric == metric; });
  return found == marks.end() ? nullptr : &*found;
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
         const Mark* mark) {
  // What was judged is told as it was judged.
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
          find_mark(result.steps[i].marks, m.metric));
  for (const MetricInfo& m : metrics())
    add(list, std::nullopt, m.metric, m.scope == MetricScope::motion ? result.motion.of(m.metric) : std::nullopt,
        find_mark(result.marks, m.metric));
  return list;
}

}  // namespace insonate
