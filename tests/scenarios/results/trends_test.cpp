#include "scenarios/results/trends.h"

#include <catch2/catch.hpp>

using namespace insonate;

namespace {

CriterionScore scored(Metric metric, double points, double weight) {
  CriterionScore score;
  score.metric = metric;
  score.points = points;
  score.weight = weight;
  return score;
}

/// A step with a distance (weight 4) and an angle (weight 2), and the exam's time (weight 1).
ExamResult result_of(double distance, double angle, double time) {
  ExamResult result;
  StepResult& step = result.steps.emplace_back();
  step.title = "Liver";
  step.outcome = StepOutcome::held;
  step.criteria = {scored(Metric::plane_distance_mm, distance, 4), scored(Metric::plane_angle_deg, angle, 2)};
  result.criteria = {scored(Metric::time_s, time, 1)};
  return result;
}

}  // namespace

TEST_CASE("criteria are in the order of the points that they lose, with their shares attempt by attempt") {
  const ExamResult first = result_of(1, 2, 0.5), second = result_of(3, 2, 1);
  const std::vector<CriterionTrend> trends = criterion_trends({{0, &first}, {1, &second}});
  REQUIRE(trends.size() == 3);
  CHECK(trends[0].metric == Metric::plane_distance_mm);
  CHECK(trends[0].step == 0u);
  CHECK(trends[0].step_title == "Liver");
  CHECK(trends[0].weight == 4);
  CHECK(trends[0].lost == 2);
  CHECK(trends[0].shares == std::vector<std::optional<double>>{0.25, 0.75});
  CHECK(trends[1].metric == Metric::time_s);
  CHECK_FALSE(trends[1].step);
  CHECK(trends[1].lost == 0.25);
  CHECK(trends[2].lost == 0);
  CHECK(trends[2].shares == std::vector<std::optional<double>>{1, 1});
}

TEST_CASE("a group's share is the mean of its learners, and of those that were judged alone") {
  const ExamResult a = result_of(4, 2, 1), b = result_of(0, 2, 1), c = result_of(2, 2, 1);
  ExamResult skipped = result_of(0, 0, 1);
  skipped.steps[0].outcome = StepOutcome::skipped;
  const auto trends = criterion_trends({{0, &a}, {0, &b}, {1, &skipped}, {2, &c}});
  const auto distance = std::find_if(trends.begin(), trends.end(),
                                     [](const CriterionTrend& t) { return t.metric == Metric::plane_distance_mm; });
  REQUIRE(distance != trends.end());
  CHECK(distance->shares == std::vector<std::optional<double>>{0.5, std::nullopt, 0.5});
  CHECK(distance->lost == 2);
}

TEST_CASE("a warm-up and a criterion without points are nobody's loss, and hints are distinguished") {
  ExamResult result = result_of(1, 1, 1);
  result.steps[0].counts = false;
  result.criteria.push_back(scored(Metric::path_length_mm, 0, 0));
  const auto trends = criterion_trends({{0, &result}});
  REQUIRE(trends.size() == 1);
  CHECK(trends[0].metric == Metric::time_s);
  ExamResult hinted = result_of(4, 2, 1);
  hinted.steps[0].hint_cost = 1.5;
  CHECK(mean_lost_to_hints({{0, &result}, {1, &hinted}}) == 0.75);
  CHECK(mean_lost_to_hints({}) == 0);
}
