#include <catch2/catch.hpp>

#include "scenarios/result_json.h"
#include "sim/core/hash.h"
#include "tests/scenarios/tiny_exam.h"

using namespace insonate;

namespace {

/// One step of each kind that measures something of its own, and the motion of all.
const Scenario& exam() {
  static const Scenario scenario = exam_of(
      step("set_knobs", "depth_mm = [110, 130]\ngain_db = [3, 6]\nhold_s = 0.5\ntime_limit_s = 1.4",
           "knobs_right_percent") +
      step("sweep", "organ = [\"ball\"]\nkeep = [\"centre\"]\ntime_limit_s = 4.6", "coverage_percent") +
      "[[step.criterion]]\nmetric = \"kept_in_view_percent\"\nfull = 60\nzero = 0\n" +
      step("measure",
           "view = \"ball\"\ntool = \"distance\"\nwalls = \"outer to outer\"\n[[step.target]]\n"
           "structures = [\"ball\"]\nthrough = \"centre\"\nalong = \"lateral\"",
           "measurement_error_mm", "full = 0\nzero = 20") +
      "[[step.criterion]]\nmetric = \"measurement_offset_mm\"\nfull = 0\nzero = 30\n"
      "[[step.criterion]]\nmetric = \"plane_distance_mm\"\nfull = 0\nzero = 30\n" +
      step("mark_point", "landmark = \"top\"", "point_error_mm", "full = 0\nzero = 40") +
      step("label_structures", "structures = [\"ball\", \"rib\"]", "labels_right_percent") +
      step("question", "answer = \"number\"\nright_number = 40\nwithin = 2", "answer_error", "full = 0\nzero = 20") +
      step("find_view", "view = \"ball\"\ntime_limit_s = 4\n[step.tolerance]\nplane_distance_mm = 6", "plane_angle_deg",
           "full = 0\nzero = 40") +
      "[[step.criterion]]\nmetric = \"longest_hold_s\"\nfull = 1\nzero = 0\n"
      "[[criterion]]\nmetric = \"path_length_mm\"\nfull = 50\nzero = 2000\n"
      "[[criterion]]\nmetric = \"angular_path_deg\"\nfull = 10\nzero = 2000\n");
  return scenario;
}

/// What a learner does, at their own times; `clumsy` is how far off they are, 0 not at all.
struct Learner {
  double clumsy = 0;

  Pose at(double t) const {
    const double z = t < 1.5   ? -24
                     : t < 5.5 ? -24 + (48 - 20 * clumsy) * (t - 1.5) / 4
                               : (24 - 20 * clumsy) * (7 - t) / 1.5;
    return turned(clumsy * 10 * std::sin(0.9 * t), {1, 0.4, 0},
                  {clumsy * 6 * std::sin(0.7 * t), 0.5, t < 7 ? z : clumsy * 4 * std::sin(t)});
  }
  std::vector<std::pair<double, Action>> actions() const {
    const double half_mm = 20 - 8 * clumsy, aside_mm = 15 * clumsy;
    return {{0.5, {ActionKind::depth, {120}}},
            {0.6, {ActionKind::gain, {clumsy > 0.7 ? 9.0 : 4.0}}},
            {7.4, kFreeze},
            {7.6, caliper(1, aside_mm - half_mm, 60, aside_mm + half_mm, 60)},
            {8.0, kGoOn},
            {8.4, {ActionKind::point, {aside_mm, 45}}},
            {8.6, kGoOn},
            {8.8, {ActionKind::unfreeze}},
            {9.1, {ActionKind::label, {clumsy > 0.4 ? 30.0 : 0.0, 60}, "ball"}},
            {9.4, kGoOn},
            {9.8, answer(std::to_string(40 + 10 * clumsy))}};
  }
  std::vector<ProbeSample> samples(double rate_hz) const {
    return samples_of(12, rate_hz, [this](double t) { return at(t); });
  }
};

/// An action goes with the first sample at or after its time.
ActionLog log_of(const std::vector<std::pair<double, Action>>& actions, std::span<const ProbeSample> samples) {
  ActionLog log;
  for (const auto& [time_s, action] : actions)
    for (const ProbeSample& sample : samples)
      if (sample.time_s - samples.front().time_s >= time_s - kTimeRounding_s) {
        log[sample.time_s].push_back(action);
        break;
      }
  return log;
}

ExamResult scored(const Learner& learner, std::span<const ProbeSample> samples, const Case& subject = shared_case()) {
  return scored(exam(), samples, log_of(learner.actions(), samples), subject);
}

/// How far values may be off where the samples differ in rounding alone, and the labels' voxels are hit by samples of
/// the plane: of 520 cells of the ball one on the slice's border, of an extent a pixel of 0.25 mm at either end, of
/// a thousand moments of a sweep two.
double rounding_of(Metric metric) {
  switch (metric) {
    case Metric::coverage_percent:
    case Metric::kept_in_view_percent:
      return 0.25;
    case Metric::measurement_error_mm:
    case Metric::measurement_offset_mm:
      return 0.51;
    case Metric::measurement_error_percent:
      return 100 * 0.51 / 40;
    default:
      return 1e-4;
  }
}

void check_alike(const ExamResult& a, const ExamResult& b, const std::function<double(Metric)>& margin) {
  REQUIRE(a.steps.size() == b.steps.size());
  for (std::size_t i = 0; i < a.steps.size(); ++i) {
    CAPTURE(i);
    CHECK(b.steps[i].outcome == a.steps[i].outcome);
    REQUIRE(b.steps[i].criteria.size() == a.steps[i].criteria.size());
    for (std::size_t k = 0; k < a.steps[i].criteria.size(); ++k) {
      const CriterionScore &one = a.steps[i].criteria[k], &other = b.steps[i].criteria[k];
      CAPTURE(info(one.metric).name);
      REQUIRE(one.value);
      REQUIRE(other.value);
      CHECK(*other.value == Approx(*one.value).margin(margin(one.metric)).epsilon(0));
    }
  }
}

}  // namespace

TEST_CASE("every kind of step measures the same wherever patient and probe lie") {
  const Learner learner{0.3};
  std::vector<ProbeSample> samples = learner.samples(40);
  const ExamResult here = scored(learner, samples);
  for (const Pose& moved : {turned(121, {0.3, 1, -2}, {-300, 1250, 90}), turned(-40, {1, 0, 0.2}, {8, 0, -77})}) {
    std::vector<ProbeSample> there = samples;
    for (ProbeSample& sample : there) sample.patient_from_probe = moved * sample.patient_from_probe;
    check_alike(here, scored(learner, there, moved_case(shared_case(), moved)), rounding_of);
  }
}

TEST_CASE("every kind of step measures the same whenever time begins") {
  const Learner learner{0.3};
  const auto later = [&](std::vector<ProbeSample> samples, double by_s) {
    for (ProbeSample& sample : samples) sample.time_s += by_s;
    return scored(learner, samples);
  };
  // 64 Hz and a whole number of seconds: the times stay exact, and so must the score.
  const std::vector<ProbeSample> exact = learner.samples(64);
  CHECK(to_json(later(exact, 1700000000.0)) == to_json(scored(learner, exact)));
  for (const double rate : {30.0, 125.0}) {
    const std::vector<ProbeSample> samples = learner.samples(rate);
    const ExamResult before = scored(learner, samples);
    for (std::uint32_t trial = 0; trial < 2; ++trial)
      check_alike(before, later(samples, 1.7e9 + hash(trial, 3) / 4294967296.0), rounding_of);
  }
}

TEST_CASE("every kind of step measures nearly the same at any sampling rate") {
  const Learner learner{0.3};
  const ExamResult fine = scored(learner, learner.samples(400));
  // What is done goes with a sample up to 1/30 s later. The probe then moves by at most 12 mm/s over the sweep, 0.4 mm
  // of the ball's 40 (1 %), and 4 degrees a second over the hold.
  const auto margin = [](Metric metric) {
    switch (metric) {
      case Metric::coverage_percent:
      case Metric::kept_in_view_percent:
        return 1.5;
      case Metric::measurement_error_mm:
      case Metric::measurement_offset_mm:
      case Metric::plane_distance_mm:
      case Metric::point_error_mm:
        return 0.4;
      case Metric::plane_angle_deg:
        return 0.2;
      case Metric::longest_hold_s:
        return 1.0 / 30;
      default:
        return 1e-9;
    }
  };
  for (const double rate : {30.0, 60.0, 125.0}) {
    CAPTURE(rate);
    check_alike(fine, scored(learner, learner.samples(rate)), margin);
  }
}

TEST_CASE("of two scans the one that is worse in a criterion never earns more by it") {
  std::vector<ExamResult> results;
  for (const double clumsy : {0.0, 0.15, 0.3, 0.5, 0.8, 1.2, 1.8})
    results.push_back(scored(Learner{clumsy}, Learner{clumsy}.samples(30)));
  int worse = 0;
  const auto compare = [&](const std::vector<CriterionScore>& a, const std::vector<CriterionScore>& b) {
    for (std::size_t k = 0; k < a.size(); ++k) {
      const MetricInfo& metric = info(a[k].metric);
      CAPTURE(metric.name, a[k].why, b[k].why);
      if (!a[k].value || !b[k].value) {
        CHECK((a[k].value || a[k].points == 0));
        continue;
      }
      if (metric.less_is_better ? *a[k].value <= *b[k].value : *a[k].value >= *b[k].value) continue;
      ++worse;
      CHECK(a[k].points <= b[k].points);
    }
  };
  for (const ExamResult& a : results)
    for (const ExamResult& b : results) {
      for (std::size_t i = 0; i < a.steps.size(); ++i) compare(a.steps[i].criteria, b.steps[i].criteria);
      const auto done = [](const ExamResult& result) {
        return std::all_of(result.steps.begin(), result.steps.end(),
                           [](const StepResult& s) { return is_done(s.outcome); });
      };
      if (done(a) == done(b)) compare(a.criteria, b.criteria);  // economy is worth nothing where the task was not done
    }
  CHECK(worse > 100);
  // The calmest learner is nowhere worse than the clumsiest, and better in all.
  for (std::size_t i = 0; i < results.front().steps.size(); ++i)
    CHECK(results.front().steps[i].earned() > results.back().steps[i].earned());
}
