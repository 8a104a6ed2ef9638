#include "scenarios/criterion_score.h"

#include <catch2/catch.hpp>

#include <algorithm>

#include "sim/core/hash.h"

using namespace insonate;

namespace {

Criterion criterion(Metric metric, double full, double zero, double weight, bool critical = false) {
  return {metric, full, zero, weight, critical, {}};
}

ExamResult exam(std::vector<CriterionScore> marks, double pass_mark_percent) {
  ExamResult result;
  result.pass_mark_percent = pass_mark_percent;
  StepResult step;
  step.title = "Ball";
  step.outcome = StepOutcome::held;
  step.criteria = std::move(marks);
  result.steps.push_back(step);
  decide(result);
  return result;
}

}  // namespace

TEST_CASE("points fall on a straight line from full to zero") {
  const Criterion less = criterion(Metric::plane_distance_mm, 5, 20, 3);
  CHECK(score_criterion(less, 0).points == 3);
  CHECK(score_criterion(less, 5).points == 3);
  CHECK(score_criterion(less, 12.5).points == Approx(1.5));
  CHECK(score_criterion(less, 20).points == 0);
  CHECK(score_criterion(less, 1e9).points == 0);

  const Criterion more = criterion(Metric::target_in_view_percent, 80, 30, 2);
  CHECK(score_criterion(more, 95).points == 2);
  CHECK(score_criterion(more, 55).points == Approx(1));
  CHECK(score_criterion(more, 30).points == 0);
  CHECK(score_criterion(more, 0).points == 0);
}

TEST_CASE("of no metric does a worse value ever earn more than a better one") {
  std::uint32_t draw = 0;
  const auto uniform = [&] { return 200 * (hash(11, ++draw) / 4294967296.0) - 100; };
  for (const MetricInfo& m : metrics())
    for (int trial = 0; trial < 40; ++trial) {
      const double one = uniform(), other = uniform(), a = uniform(), b = uniform();
      const bool less = m.less_is_better;
      const Criterion asked = criterion(m.metric, less ? std::min(one, other) : std::max(one, other),
                                        less ? std::max(one, other) : std::min(one, other), 3);
      CAPTURE(m.name, asked.full, asked.zero, a, b);
      const double better = score_criterion(asked, less ? std::min(a, b) : std::max(a, b)).points;
      const double worse = score_criterion(asked, less ? std::max(a, b) : std::min(a, b)).points;
      CHECK(worse <= better);
      CHECK(worse >= 0);
      CHECK(better <= 3);
    }
}

TEST_CASE("a mark says why") {
  const Criterion less = criterion(Metric::plane_distance_mm, 5, 20, 3);
  CHECK(score_criterion(less, 4.04).why == "4.0 mm: full points for 5.0 mm or less.");
  CHECK(score_criterion(less, 12.5).why == "12.5 mm: between full points at 5.0 mm and none at 20.0 mm.");
  CHECK(score_criterion(less, 33).why == "33.0 mm: nothing for 20.0 mm or more.");
  const Criterion more = criterion(Metric::target_in_view_percent, 80, 30, 2);
  CHECK(score_criterion(more, 95).why == "95 %: full points for 80 % or more.");
  CHECK(score_criterion(more, 12).why == "12 %: nothing for 30 % or less.");
  Criterion from_none = more;
  from_none.zero = 0;
  CHECK(score_criterion(from_none, 0).why == "0 %: no points.");
  CHECK(score_criterion(more, std::nullopt, "nothing was seen.").why == "nothing was seen.");
  CHECK(score_criterion(more, std::nullopt, "nothing was seen.").points == 0);
  CHECK(score_criterion(criterion(Metric::tilt_deg, 5, 20, 1), 3).why ==
        "3.0\u00b0: full points for 5.0\u00b0 or less.");
}

TEST_CASE("the exam is passed from the pass mark on") {
  const CriterionScore half = score_criterion(criterion(Metric::plane_distance_mm, 0, 10, 2), 5);
  const CriterionScore all = score_criterion(criterion(Metric::tilt_deg, 5, 20, 2), 0);
  const ExamResult passed = exam({half, all}, 75);
  CHECK(passed.points == 3);
  CHECK(passed.points_possible == 4);
  CHECK(passed.percent == 75);
  CHECK(passed.passed);
  CHECK(passed.reasons.empty());

  const ExamResult failed = exam({half, all}, 75.1);
  CHECK_FALSE(failed.passed);
  REQUIRE(failed.reasons.size() == 1);
  CHECK(failed.reasons[0].find("75.0 %") != std::string::npos);
}

TEST_CASE("who earns the pass mark's share of the points passes, whatever their sum rounds to") {
  for (const double weight : {0.1, 0.3, 0.7, 1.0, 1.1, 2.3})
    for (const int all : {5, 10, 15, 20}) {
      CAPTURE(weight, all);
      std::vector<CriterionScore> criteria;
      for (int i = 0; i < all; ++i)
        criteria.push_back(score_criterion(criterion(Metric::tilt_deg, 5, 20, weight), 5 * i < 4 * all ? 0 : 90));
      CHECK(exam(criteria, 80).passed);
      criteria.front().points = 0;
      CHECK_FALSE(exam(criteria, 80).passed);
    }
}

TEST_CASE("a failed score is never shown as the pass mark or above, nor the pass mark as another") {
  const auto reason = [](double percent, double pass_mark) {
    return exam({score_criterion(criterion(Metric::plane_distance_mm, 0, 100, 1), 100 - percent)}, pass_mark)
        .reasons.front();
  };
  CHECK(reason(79.96, 80) == "The score is 79.96 %; 80 % are needed to pass.");
  CHECK(reason(79.65, 79.7) == "The score is 79.65 %; 79.7 % are needed to pass.");
  CHECK(reason(79.5, 79.7) == "The score is 79.5 %; 79.7 % are needed to pass.");
}

TEST_CASE("a critical criterion that earns nothing fails the exam alone, and is named") {
  const CriterionScore rest = score_criterion(criterion(Metric::plane_distance_mm, 5, 20, 99), 0);
  const ExamResult failed =
      exam({rest, score_criterion(criterion(Metric::target_insonated_percent, 80, 30, 1, true), 10)}, 80);
  CHECK(failed.percent == 99);
  CHECK_FALSE(failed.passed);
  REQUIRE(failed.reasons.size() == 1);
  CHECK(failed.reasons[0] == "Step 1 (Ball), critical: Target reached by the sound, 10 %: nothing for 30 % or less.");

  CHECK(exam({rest, score_criterion(criterion(Metric::target_insonated_percent, 80, 30, 1, true), 31)}, 80).passed);
}

TEST_CASE("each metric has a name of its own that leads back to it") {
  for (const MetricInfo& m : metrics()) {
    REQUIRE(find_metric(m.name));
    CHECK(*find_metric(m.name) == m.metric);
    CHECK(&info(m.metric) == &m);
  }
  CHECK_FALSE(find_metric("nothing"));
}
