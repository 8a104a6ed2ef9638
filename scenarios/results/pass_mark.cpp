#include "scenarios/results/pass_mark.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace insonate {
namespace {

GroupScores scores_of(std::span<const double> scores, const char* group) {
  GroupScores of;
  of.count = int(scores.size());
  if (of.count < 2) throw std::domain_error(std::string("there are fewer than two scores of ") + group);
  for (const double score : scores) of.mean += score / of.count;
  double squares = 0;
  for (const double score : scores) squares += (score - of.mean) * (score - of.mean);
  of.deviation = std::sqrt(squares / (of.count - 1));
  if (std::all_of(scores.begin(), scores.end(), [&](double score) { return score == scores.front(); }))
    throw std::domain_error(std::string("all scores of ") + group + " are the same, so that no normal fits them");
  return of;
}

/// Returns the share of a normal distribution below `x`, in per cent.
double below_percent(const GroupScores& group, double x) {
  return 50 * std::erfc((group.mean - x) / (group.deviation * std::sqrt(2.0)));
}

double observed_percent(std::span<const double> scores, bool below, double mark) {
  const auto wrong = std::count_if(scores.begin(), scores.end(), [&](double score) { return (score < mark) == below; });
  return 100.0 * double(wrong) / double(scores.size());
}

double crossing(const GroupScores& one, const GroupScores& two) {
  const double v1 = one.deviation * one.deviation, v2 = two.deviation * two.deviation;
  const double a = v2 - v1, half_b = -(one.mean * v2 - two.mean * v1);
  const double c =
      one.mean * one.mean * v2 - two.mean * two.mean * v1 + 2 * v1 * v2 * std::log(one.deviation / two.deviation);
  // This form stays exact for nearly equal deviations, and yields the middle for equal ones.
  const double root = std::sqrt(std::max(0.0, half_b * half_b - a * c));
  const double q = -(half_b + std::copysign(root, half_b));
  for (const double x : {c / q, q / a})
    if (std::isfinite(x) && x >= one.mean && x <= two.mean) return x;
  throw std::domain_error("the normals of novices and experts do not cross between their means");
}

}  // namespace

PassMark contrasting_groups(std::span<const double> novices, std::span<const double> experts) {
  PassMark mark;
  mark.novices = scores_of(novices, "novices");
  mark.experts = scores_of(experts, "experts");
  if (mark.experts.mean <= mark.novices.mean) throw std::domain_error("the experts are no better than the novices");
  mark.percent = crossing(mark.novices, mark.experts);
  mark.false_passes = {observed_percent(novices, false, mark.percent), 100 - below_percent(mark.novices, mark.percent)};
  mark.false_fails = {observed_percent(experts, true, mark.percent), below_percent(mark.experts, mark.percent)};
  return mark;
}

}  // namespace insonate
