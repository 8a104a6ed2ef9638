#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/result.h"

namespace insonate {

/// An attempt at a scenario, with its place among the attempts of its learner.
struct PlacedResult {
  std::size_t ordinal = 0;  ///< from 0: the learner's first attempt at the scenario
  const ExamResult* result = nullptr;
};

/// How much of its points one criterion earned, attempt by attempt.
struct CriterionTrend {
  std::optional<std::size_t> step;  ///< counted from 0; empty for the whole exam
  std::string step_title;           ///< empty for the whole exam
  Metric metric{};
  bool critical = false;
  double weight = 0;                          ///< its points in the newest attempt that was judged by it
  std::vector<std::optional<double>> shares;  ///< 0 to 1, by ordinal: the mean over the learners; empty if not judged
  double lost = 0;                            ///< points that an attempt loses by it, on average
};

/// Returns the trends of all criteria that can earn points, those that lose most points first. A step that was left out
/// or does not count is not judged.
/// @param results  attempts at one scenario, in the order of their time
std::vector<CriterionTrend> criterion_trends(const std::vector<PlacedResult>& results);

/// Returns the points that hints cost an attempt, on average.
double mean_lost_to_hints(const std::vector<PlacedResult>& results);

}  // namespace insonate
