#include "scenarios/results/trends.h"

#include <algorithm>
#include <map>
#include <utility>

namespace insonate {
namespace {

/// A trend, and the sums that its means are made of.
struct Sums {
  CriterionTrend trend;
  std::vector<double> shares;         ///< by ordinal
  std::vector<std::size_t> learners;  ///< that were judged, by ordinal
  double lost = 0;
  std::size_t judged = 0;

  void add(std::size_t ordinal, const CriterionScore& score) {
    if (shares.size() <= ordinal) {
      shares.resize(ordinal + 1);
      learners.resize(ordinal + 1);
    }
    shares[ordinal] += std::clamp(score.points / score.weight, 0.0, 1.0);
    ++learners[ordinal];
    lost += score.weight - score.points;
    ++judged;
    trend.weight = score.weight;
    trend.critical = score.critical;
  }
};

}  // namespace

std::vector<CriterionTrend> criterion_trends(const std::vector<PlacedResult>& results) {
  // A key of the step and the metric; the whole exam comes after the steps.
  std::map<std::pair<std::size_t, Metric>, Sums> all;
  std::size_t attempts = 0;
  for (const PlacedResult& placed : results) {
    attempts = std::max(attempts, placed.ordinal + 1);
    const auto add = [&](std::size_t part, const StepResult* step, const std::vector<CriterionScore>& criteria) {
      for (const CriterionScore& score : criteria) {
        if (score.weight <= 0) continue;
        Sums& sums = all[{part, score.metric}];
        sums.trend.metric = score.metric;
        if (step) {
          sums.trend.step = part;
          sums.trend.step_title = step->title;
        }
        sums.add(placed.ordinal, score);
      }
    };
    const std::vector<StepResult>& steps = placed.result->steps;
    for (std::size_t i = 0; i < steps.size(); ++i)
      if (steps[i].counts && steps[i].outcome != StepOutcome::skipped) add(i, &steps[i], steps[i].criteria);
    add(std::size_t(-1), nullptr, placed.result->criteria);
  }
  std::vector<CriterionTrend> trends;
  for (auto& [key, sums] : all) {
    CriterionTrend& trend = trends.emplace_back(std::move(sums.trend));
    trend.shares.resize(attempts);
    for (std::size_t i = 0; i < sums.shares.size(); ++i)
      if (sums.learners[i] > 0) trend.shares[i] = sums.shares[i] / double(sums.learners[i]);
    trend.lost = sums.lost / double(sums.judged);
  }
  std::stable_sort(trends.begin(), trends.end(),
                   [](const CriterionTrend& a, const CriterionTrend& b) { return a.lost > b.lost; });
  return trends;
}

double mean_lost_to_hints(const std::vector<PlacedResult>& results) {
  double lost = 0;
  for (const PlacedResult& placed : results)
    for (const StepResult& step : placed.result->steps) lost += step.lost_to_hints();
  return results.empty() ? 0 : lost / double(results.size());
}

}  // namespace insonate
