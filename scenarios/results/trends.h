#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/result.h"

namespace insonate {

/// The spread of a group's values.
struct Spread {
  double lower = 0, median = 0, upper = 0;  ///< lower and upper are the quartiles
};

/// Returns the median and the quartiles of at least one value. A quartile between two values is interpolated, as
/// Hyndman and Fan's definition 7 does it (American Statistician 50, 1996), which spreadsheets use.
Spread spread_of(std::vector<double> values);

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
