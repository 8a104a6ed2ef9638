#include "scenarios/words.h"

#include <algorithm>
#include <cstdlib>

#include "sim/core/text.h"

namespace insonate {

std::string fixed(double value, int decimals) {
  return formatted("%.*f", decimals, value);
}

std::string short_number(double value) {
  std::string text = fixed(value, 2);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string in_words(Metric metric, double value) {
  const MetricInfo& m = info(metric);
  // Relative to the reference view, which need not be the one that shows most.
  if ((metric == Metric::target_insonated_percent || metric == Metric::target_in_view_percent) && value >= 100.5)
    return "over 100 %";
  const bool degrees = m.unit == "\u00b0";
  return fixed(value, m.decimals) + (m.unit.empty() || degrees ? "" : " ") + std::string(m.unit);
}

std::string unbroken(std::string_view sentence) {
  std::string text;
  for (std::size_t i = 0; i < sentence.size(); ++i) {
    const bool after_number = i > 0 && sentence[i - 1] >= '0' && sentence[i - 1] <= '9';
    if (sentence[i] == ' ' && after_number)
      text += "\u00a0";
    else
      text += sentence[i];
  }
  return text;
}

std::string title_of(Metric metric) {
  const MetricInfo& m = info(metric);
  return std::string(m.words) + (m.of_reference ? " (100 %: the reference view)" : "");
}

std::string title_of_fact(const std::string& name, const std::string& fact) {
  const bool of_volume = name == StepResult::kLengths && std::count(fact.begin(), fact.end(), ',') == 2;
  return of_volume ? "length, depth, width" : in_words(name);
}

std::string in_words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string in_words(StepOutcome outcome) {
  switch (outcome) {
    case StepOutcome::held:
      return "view held";
    case StepOutcome::done:
      return "done";
    case StepOutcome::went_on:
      return "ended early by the learner";
    case StepOutcome::timed_out:
      return "time ran out";
    case StepOutcome::scan_ended:
      return "scan ended first";
    case StepOutcome::skipped:
      return "left out";
    case StepOutcome::not_reached:
      return "not reached";
  }
  return "";
}

std::string score_in_words(const StepResult& step) {
  const double possible = step.possible(), earned = step.earned();
  if (possible <= 0) return "does not count";
  return short_number(earned) + " of " + short_number(possible) + " points" +
         (!is_done(step.outcome) && earned > 0 ? " for what was reached" : "");
}

std::string percentage(const ExamResult& result) {
  const auto misleads = [&](const std::string& text) {
    return result.percent < result.pass_mark_percent && std::atof(text.c_str()) >= result.pass_mark_percent;
  };
  constexpr int kMaxDecimals = 12;
  int decimals = 1;
  while (!result.passed && decimals < kMaxDecimals && misleads(fixed(result.percent, decimals))) ++decimals;
  return fixed(result.percent, decimals);
}

}  // namespace insonate
