#include "scenarios/runner.h"

#include <catch2/catch.hpp>

#include "scenarios/report/report.h"
#include "scenarios/result_json.h"
#include "sim/core/hash.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

const Case& shared_case() {
  static const Case subject = tiny_case();
  return subject;
}

Scenario tiny_scenario() {
  return parse_scenario(kTinyScenario, "exam.toml");
}

ExamResult scored(const std::vector<ProbeSample>& samples, const Scenario& scenario = tiny_scenario(),
                  const Case& subject = shared_case()) {
  Runner runner(scenario, subject, tiny_tissues());
  runner.feed(samples);
  runner.end();
  return runner.result();
}

Pose at_z(double z) {
  return {glm::dmat3(1.0), {0, 0, z}};
}

/// From 40 mm aside at 20 mm/s to 4 mm off the ball's plane, and there it stays: in tolerance from 1.6 s on.
Pose approach(double t) {
  return at_z(std::max(4.0, 40 - 20 * t));
}

/// A scan with everything in it: turns, losses of tracking, a wrong place, the right one.
std::vector<ProbeSample> wandering(double rate_hz) {
  auto samples = samples_of(14, rate_hz, [](double t) {
    const double off = 25 * std::exp(-t / 2) * std::sin(2 * t) + 3;
    return turned(10 * std::sin(t) * std::exp(-t / 3), {1, 0.4, 0}, {4 * std::sin(0.7 * t), 0.5, off});
  });
  for (ProbeSample& sample : samples)
    if (std::fmod(sample.time_s + 1, 3.1) < 0.4) sample.status = PoseStatus::missing;
  return samples;
}

}  // namespace

TEST_CASE("a scan's score can be computed by hand") {
  const ExamResult result = scored(samples_of(6, 50, approach));
  REQUIRE(result.complete);
  REQUIRE(result.steps.size() == 2);
  const StepResult& first = result.steps[0];
  CHECK(first.outcome == StepOutcome::held);
  CHECK(first.start_s == 0);
  // In tolerance from 8 mm on, at 1.6 s; the grid of samples adds 0.02 s at most.
  CHECK(*first.judged_from_s == Approx(1.6).margin(0.021));
  CHECK(first.end_s == Approx(2.6).margin(0.021));
  CHECK(first.longest_hold_s == 1.0);
  // Over the hold the distance falls from 8 to 4 mm in 0.2 s and stays there for 0.8 s: 0.2 * 6 + 0.8 * 4 = 4.4 mm.
  CHECK(first.judged->plane_distance_mm == Approx(4.4).margin(0.05));
  REQUIRE(first.criteria.size() == 2);
  CHECK(first.criteria[0].points == Approx(4 * (10 - first.judged->plane_distance_mm) / 8));
  CHECK(first.criteria[1].points == 2);  // the disc at 4.4 mm is 95 % of the largest, more than 80

  const StepResult& second = result.steps[1];
  CHECK(second.outcome == StepOutcome::held);
  CHECK(second.start_s == first.end_s);
  CHECK(second.end_s == Approx(first.end_s + 0.5).margin(0.021));
  CHECK(second.criteria[0].points == 1);
  // No time is lost between the steps.
  CHECK(first.motion.time_s + second.motion.time_s == Approx(result.motion.time_s));
  CHECK(second.motion.tracked_s == Approx(second.end_s - second.start_s));

  CHECK(result.motion.time_s == Approx(3.1).margin(0.021));
  CHECK(result.motion.path_length_mm == Approx(36));
  CHECK(result.criteria[0].points == 3);  // 36 mm of way are less than 50
  CHECK(result.points == Approx(2.8 + 2 + 1 + 3).margin(0.03));
  CHECK(result.points_possible == 10);
  CHECK(result.percent == Approx(88).margin(0.3));
  CHECK(result.passed);
}

TEST_CASE("who never shows the view runs out of time, is judged by the last second, and is informed") {
  const ExamResult result = scored(samples_of(25, 20, [](double) { return at_z(60); }));
  CHECK(result.complete);
  CHECK_FALSE(result.passed);
  CHECK(result.steps[0].outcome == StepOutcome::timed_out);
  CHECK(result.steps[0].end_s == 10);
  CHECK(result.steps[0].motion.time_s == Approx(10));
  CHECK(result.steps[1].start_s == 10);
  CHECK(result.steps[1].end_s == 20);
  CHECK(*result.steps[0].judged_from_s == Approx(8.95).margin(0.051));
  CHECK(result.steps[0].judged->plane_distance_mm == Approx(60));
  CHECK(result.motion.time_s == Approx(20));
  REQUIRE(result.reasons.size() >= 3);
  CHECK(result.reasons[0].find("60 % are needed") != std::string::npos);
  CHECK(result.reasons[1].find("Step 1 (Ball): the view was not held long enough") != std::string::npos);
  const std::string missed = "Distance of the target from the plane: 60.0 mm, asked for: 8.0 mm or less";
  REQUIRE_FALSE(result.steps[0].facts.empty());
  CHECK(result.steps[0].facts[0] == std::pair<std::string, std::string>{StepResult::kNotHeld, missed});
  CHECK(result.reasons[2].find("critical") != std::string::npos);
}

TEST_CASE("the exam's time limit ends it at once, and what was not reached earns nothing") {
  Scenario scenario = tiny_scenario();
  scenario.time_limit_s = 2;
  const ExamResult result = scored(samples_of(6, 50, approach), scenario);
  CHECK(result.complete);
  CHECK(result.steps[0].outcome == StepOutcome::timed_out);
  CHECK(result.steps[0].end_s == 2);
  CHECK(result.steps[0].longest_hold_s == Approx(0.38).margin(0.021));
  CHECK(result.steps[1].outcome == StepOutcome::not_reached);
  CHECK(result.steps[1].criteria[0].points == 0);
  CHECK(result.steps[1].criteria[0].why == "the step was not reached.");
  CHECK(result.motion.time_s == Approx(2));
}

TEST_CASE("an exam whose samples end early is scored as far as it came") {
  const ExamResult result = scored(samples_of(1.0, 50, approach));
  CHECK(result.complete);
  CHECK(result.steps[0].outcome == StepOutcome::scan_ended);
  CHECK(result.steps[1].outcome == StepOutcome::not_reached);
  CHECK_FALSE(result.passed);

  Runner empty(tiny_scenario(), shared_case(), tiny_tissues());
  empty.end();
  CHECK_FALSE(empty.result().complete);
  CHECK(empty.result().points == 0);
}

TEST_CASE("giving up at once earns nothing for being quick") {
  const ExamResult result = scored(samples_of(1.0, 50, approach));
  REQUIRE(result.criteria[0].metric == Metric::path_length_mm);
  CHECK(*result.criteria[0].value < 50);
  CHECK(result.criteria[0].points == 0);
  CHECK(result.criteria[0].why.find("the task was not done") != std::string::npos);
}

TEST_CASE("a hold survives a loss of tracking of a blink, not a longer one") {
  const auto with_loss = [](double loss_s) {
    auto samples = samples_of(2.4, 50, [](double) { return at_z(0); });
    for (ProbeSample& sample : samples)
      if (sample.time_s > 0.505 && sample.time_s < 0.505 + loss_s) sample.status = PoseStatus::out_of_view;
    return scored(samples).steps[0];
  };
  CHECK(with_loss(0.0).end_s == Approx(1.0));
  CHECK(with_loss(0.2).end_s == Approx(1.0));
  CHECK(with_loss(0.4).end_s == Approx(1.92).margin(0.021));

  // The same for a tracker that says nothing at all while it is lost.
  auto silent = samples_of(2.4, 50, [](double) { return at_z(0); });
  silent.erase(silent.begin() + 26, silent.begin() + 46);
  CHECK(scored(silent).steps[0].end_s == Approx(1.92).margin(0.021));
}

TEST_CASE("a loss at the end or the beginning of a hold moves that end, and a loss in between is judged over") {
  const auto lost_between = [](double from_s, double to_s) {
    auto samples = samples_of(3, 50, [](double t) { return at_z(t < 0.495 ? 60 : 0); });
    for (ProbeSample& sample : samples)
      if (sample.time_s > from_s - 0.01 && sample.time_s < to_s + 0.01) sample.status = PoseStatus::missing;
    return scored(samples).steps[0];
  };
  CHECK(lost_between(9, 9).end_s == Approx(1.5));
  // At its beginning: the view counts from when it is seen.
  CHECK(*lost_between(0.5, 0.6).judged_from_s == Approx(0.62));
  CHECK(lost_between(0.5, 0.6).end_s == Approx(1.62));
  // At its end: it is over when the view is seen again, unless tracking was away for too long.
  CHECK(lost_between(1.5, 1.6).end_s == Approx(1.62));
  CHECK(lost_between(1.5, 1.6).judged->plane_distance_mm == Approx(0).margin(1e-9));
  CHECK(lost_between(1.5, 1.7).end_s == Approx(1.72));
  CHECK(lost_between(1.5, 1.8).end_s == Approx(2.82));
  CHECK(*lost_between(1.5, 1.8).judged_from_s == Approx(1.82));
}

TEST_CASE("a step begins with the sample that ended the one before") {
  for (const double rate : {10.0, 50.0, 100.0}) {
    CAPTURE(rate);
    const ExamResult result = scored(samples_of(2, rate, [](double) { return at_z(0); }));
    CHECK(result.steps[0].end_s == Approx(1.0));
    CHECK(result.steps[1].end_s == Approx(1.5));
    CHECK(*result.steps[1].judged_from_s == Approx(1.0));
  }
}

TEST_CASE("a hold that ends with the scan counts, one that is a sample short does not") {
  const ExamResult enough = scored(samples_of(1.0, 50, [](double) { return at_z(0); }));
  CHECK(enough.steps[0].outcome == StepOutcome::held);
  CHECK(enough.steps[1].outcome == StepOutcome::scan_ended);
  CHECK(enough.steps[1].longest_hold_s == 0);
  const ExamResult less = scored(samples_of(0.98, 50, [](double) { return at_z(0); }));
  CHECK(less.steps[0].outcome == StepOutcome::scan_ended);
  CHECK(less.steps[0].longest_hold_s == Approx(0.98));
}

TEST_CASE("a hold that ends at the time limit comes too late, wherever time begins") {
  // Tenths are not doubles, and times since 1970 are rounded once more: some limits lie above their sample, some below.
  for (int tenths = 90; tenths <= 99; ++tenths)
    for (const double begin_s : {0.0, 1.7e9}) {
      const double limit_s = tenths / 10.0;
      CAPTURE(limit_s, begin_s);
      Scenario scenario = tiny_scenario();
      scenario.steps[0].time_limit_s = limit_s;
      const auto held_from = [&](double from_s) {
        auto samples = samples_of(11, 50, [&](double t) { return at_z(t > from_s - 0.01 ? 0 : 60); });
        for (ProbeSample& sample : samples) sample.time_s += begin_s;
        return scored(samples, scenario);
      };
      const ExamResult late = held_from(limit_s - 1);
      CHECK(late.steps[0].outcome == StepOutcome::timed_out);
      CHECK(late.steps[0].end_s == limit_s);
      CHECK(late.steps[0].longest_hold_s == Approx(0.98));
      CHECK(late.steps[1].motion.time_s == Approx(0.5));
      const ExamResult in_time = held_from(limit_s - 1.02);
      CHECK(in_time.steps[0].outcome == StepOutcome::held);
      CHECK(in_time.steps[0].end_s == Approx(limit_s - 0.02));
    }
}

TEST_CASE("a hold survives a loss of just a quarter of a second at any moment, also when the tracker falls silent") {
  for (std::size_t last = 1; last <= 14; ++last)
    for (const double begin_s : {0.0, 1.7e9})
      for (const bool silent : {false, true}) {
        CAPTURE(last, begin_s, silent);
        auto samples = samples_of(2, 20, [](double) { return at_z(0); });
        for (ProbeSample& sample : samples) sample.time_s += begin_s;
        for (std::size_t i = last + 1; i < last + 5; ++i) samples[i].status = PoseStatus::missing;
        if (silent) samples.erase(samples.begin() + long(last) + 1, samples.begin() + long(last) + 5);
        CHECK(scored(samples).steps[0].end_s == Approx(1.0));
      }
}

TEST_CASE("of samples at one time the first counts") {
  const std::vector<ProbeSample> clean = wandering(30);
  std::vector<ProbeSample> twice;
  for (const ProbeSample& sample : clean) {
    twice.push_back(sample);
    twice.push_back(sample_at(sample.time_s, at_z(40)));
    twice.push_back(sample_at(sample.time_s, at_z(0), PoseStatus::missing));
  }
  CHECK(to_json(scored(twice)) == to_json(scored(clean)));
}

TEST_CASE("an exam of one step that earns nothing by itself ends with its hold") {
  Scenario scenario = tiny_scenario();
  scenario.steps.pop_back();
  scenario.steps[0].criteria.clear();
  const ExamResult result = scored(samples_of(6, 50, approach), scenario);
  CHECK(result.complete);
  CHECK(result.steps[0].outcome == StepOutcome::held);
  CHECK(result.motion.time_s == Approx(result.steps[0].end_s));
  CHECK(result.points == 3);
  CHECK(result.points_possible == 3);
  CHECK(result.passed);
  // And who never gets there earns nothing for moving little.
  const ExamResult never = scored(samples_of(12, 50, [](double) { return at_z(60); }), scenario);
  CHECK(never.complete);
  CHECK(never.points == 0);
  CHECK_FALSE(never.passed);
}

TEST_CASE("a pose that is not valid is never looked at") {
  auto samples = samples_of(3, 50, [](double) { return at_z(0); });
  for (ProbeSample& sample : samples) {
    sample.status = PoseStatus::missing;
    sample.patient_from_probe.translation.x = std::nan("");
  }
  const ExamResult result = scored(samples);
  CHECK_FALSE(result.steps[0].judged);
  CHECK(result.steps[0].criteria[0].points == 0);
  CHECK(result.steps[0].criteria[0].why == "there was no valid pose to judge.");
  CHECK(*result.motion.of(Metric::dropout_percent) == Approx(100));

  // Neither is one that is called valid and is not a number, nor one whose time goes back.
  auto spoiled = samples_of(6, 50, approach);
  const ExamResult clean = scored(spoiled);
  ProbeSample broken = sample_at(1.5001, at_z(0));
  broken.patient_from_probe.rotation[1][1] = std::nan("");
  spoiled.insert(spoiled.begin() + 76, {broken, sample_at(0.3, at_z(0))});
  CHECK(to_json(scored(spoiled)) == to_json(clean));
}

TEST_CASE("the score is the same to the bit however the samples are fed") {
  const std::vector<ProbeSample> samples = wandering(60);
  const std::string at_once = to_json(scored(samples));
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    Runner runner(tiny_scenario(), shared_case(), tiny_tissues());
    std::size_t next = 0;
    for (std::uint32_t batch = 0; next < samples.size(); ++batch) {
      const std::size_t size = std::min<std::size_t>(hash(seed, batch) % 9, samples.size() - next);
      runner.feed(std::span(samples).subspan(next, size));
      runner.result();  // looking on the way, as a screen does, changes nothing
      next += size;
    }
    runner.end();
    CHECK(to_json(runner.result()) == at_once);
  }
}

TEST_CASE("the score does not depend on where time begins") {
  std::vector<ProbeSample> samples = wandering(64);
  const ExamResult before = scored(samples);
  // 64 Hz and a whole number of seconds: the times stay exact, and so must the score.
  for (ProbeSample& sample : samples) sample.time_s += 1700000000.0;
  CHECK(to_json(scored(samples)) == to_json(before));
}

TEST_CASE("where times round the score does not depend on where time begins either") {
  for (const double rate : {20.0, 30.0, 250.0}) {
    const std::vector<ProbeSample> samples = wandering(rate);
    const ExamResult before = scored(samples);
    for (std::uint32_t trial = 0; trial < 4; ++trial) {
      const double begin_s = 1.7e9 + hash(trial, 3) / 4294967296.0;
      CAPTURE(rate, begin_s);
      std::vector<ProbeSample> later = samples;
      for (ProbeSample& sample : later) sample.time_s += begin_s;
      const ExamResult after = scored(later);
      // Times are off by 0.24 microseconds, at 30 mm/s a hundred thousandth of a millimetre.
      CHECK(after.points == Approx(before.points).margin(1e-4));
      for (std::size_t i = 0; i < before.steps.size(); ++i) {
        CHECK(after.steps[i].outcome == before.steps[i].outcome);
        CHECK(after.steps[i].end_s == Approx(before.steps[i].end_s).margin(1e-6));
      }
      CHECK(after.motion.path_length_mm == Approx(before.motion.path_length_mm).margin(1e-3));
      CHECK(after.motion.dropouts == before.motion.dropouts);
      CHECK(after.motion.rotational_movements == before.motion.rotational_movements);
    }
  }
}

TEST_CASE("the score hardly depends on the sampling rate") {
  const ExamResult fine = scored(wandering(400));
  REQUIRE(fine.steps[1].outcome == StepOutcome::held);
  for (const double rate : {30.0, 60.0, 125.0, 250.0, 1000.0}) {
    const ExamResult coarse = scored(wandering(rate));
    INFO(rate);
    // A hold begins and ends up to a sample later each, 1/30 s at the coarsest; the view moves by at most about
    // 30 mm/s then, which is 1 mm of distance or an eighth of the line's 8 mm of its 4 points.
    CHECK(coarse.points == Approx(fine.points).margin(0.5));
    CHECK(coarse.motion.time_s == Approx(fine.motion.time_s).margin(0.2));
  }
}

TEST_CASE("the picture is looked at no more than every 9 ms, and at once after a loss") {
  Runner runner(tiny_scenario(), shared_case(), tiny_tissues());
  const auto distance_mm = [&](double time_s, PoseStatus status = PoseStatus::ok) {
    ProbeSample sample = sample_at(time_s, at_z(30 + 10 * time_s));  // not yet within tolerance
    sample.status = status;
    runner.feed(sample);
    return runner.live().view ? std::optional(runner.live().view->plane_distance_mm) : std::nullopt;
  };
  std::vector<double> times_s;
  double before = distance_mm(0).value();
  for (int ms = 1; ms <= 40; ++ms) {
    const double now = distance_mm(ms / 1000.0).value();
    if (now != before) times_s.push_back(ms / 1000.0);
    before = now;
  }
  CHECK(times_s == std::vector<double>{0.009, 0.018, 0.027, 0.036});
  CHECK_FALSE(distance_mm(0.041, PoseStatus::missing));
  CHECK(runner.live().tracking == PoseStatus::missing);
  CHECK(distance_mm(0.042).value() != before);
  INFO("the motion is that of every sample");
  CHECK(runner.live().elapsed_s == 0.042);
}

TEST_CASE("the score does not depend on where the patient lies") {
  const Pose moved = turned(121, {0.3, 1, -2}, {-300, 1250, 90});
  const Case elsewhere = moved_case(shared_case(), moved);
  std::vector<ProbeSample> samples = wandering(60);
  const ExamResult here = scored(samples);
  for (ProbeSample& sample : samples) sample.patient_from_probe = moved * sample.patient_from_probe;
  const ExamResult there = scored(samples, tiny_scenario(), elsewhere);
  // Rounding alone, and samples on voxel borders: see the same test of the view's metrics.
  CHECK(there.points == Approx(here.points).margin(1e-3));
  CHECK(there.motion.path_length_mm == Approx(here.motion.path_length_mm).epsilon(1e-9));
  CHECK(there.steps[0].end_s == here.steps[0].end_s);
}

TEST_CASE("what the screen shows follows the exam") {
  Runner runner(tiny_scenario(), shared_case(), tiny_tissues());
  CHECK_FALSE(runner.live().started);
  const auto samples = samples_of(6, 50, approach);
  runner.feed(std::span(samples).first(51));  // to 1.0 s
  CHECK(runner.live().started);
  CHECK(runner.live().elapsed_s == Approx(1));
  CHECK(runner.live().step_remaining_s == Approx(9));
  CHECK(runner.live().exam_remaining_s == Approx(29));
  CHECK(runner.live().view->plane_distance_mm == Approx(-20));
  CHECK(runner.live().on_skin);
  CHECK_FALSE(runner.live().within_tolerance);
  CHECK(runner.live().hold_share == 0);

  runner.feed(std::span(samples).subspan(51, 55));  // to 2.1 s
  CHECK(runner.live().within_tolerance);
  CHECK(runner.live().hold_share == Approx(0.5).margin(0.021));

  runner.feed(std::span(samples).subspan(106));
  CHECK(runner.live().finished);
  CHECK(runner.live().step == 1);
  CHECK(runner.live().points == Approx(5.8).margin(0.03));
  CHECK(runner.live().points_possible == 7);
  const std::string finished = to_json(runner.result());
  runner.feed(sample_at(100, at_z(0)));
  runner.end();
  CHECK(to_json(runner.result()) == finished);
}

TEST_CASE("a result of an exam under way is not called complete") {
  Runner runner(tiny_scenario(), shared_case(), tiny_tissues());
  runner.feed(samples_of(1, 50, approach));
  CHECK_FALSE(runner.result().complete);
}

TEST_CASE("a scenario that does not fit the case does not start") {
  Scenario scenario = tiny_scenario();
  scenario.steps[1].view = "cube";
  CHECK_THROWS_AS(Runner(scenario, shared_case(), tiny_tissues()), ScenarioError);
}

TEST_CASE("a better scan never earns less on what it is better in") {
  double last = 1e9;
  for (const double offset : {0.0, 2.5, 4.0, 6.0, 7.5}) {
    const double points = scored(samples_of(4, 50, [&](double) { return at_z(offset); })).steps[0].criteria[0].points;
    CHECK(points <= last);
    last = points;
  }
  CHECK(last == Approx(4 * 2.5 / 8));
}

TEST_CASE("the result counts how often and for how long the guide was shown, and nothing else of it") {
  const std::vector<ProbeSample> samples = samples_of(8, 50, [](double t) { return at_z(t < 6 ? 60 : 0); });
  const auto guided = [&](const ActionLog& actions) {
    Scenario scenario = tiny_scenario();
    scenario.steps[0].time_limit_s = 4;
    Runner runner(scenario, shared_case(), tiny_tissues());
    runner.feed(samples, actions);
    runner.end();
    return runner.result();
  };
  const Action on{ActionKind::guide, {1}}, off{ActionKind::guide, {0}};
  ExamResult result = guided({{1.0, {on}}, {1.5, {off}}, {3.0, {on}}});
  CHECK(result.steps[0].guide_times == 2);
  CHECK(result.steps[0].guide_s == Approx(0.5 + 1));
  CHECK(result.steps[1].guide_times == 1);  // it stays on in the next step, which ends at 6.5 s
  CHECK(result.steps[1].guide_s == Approx(2.5));
  const std::string json = to_json(result), html = report_html(result, {});
  CHECK(result_from_json(json, "x").steps[0].guide_s == result.steps[0].guide_s);
  CHECK(to_json(result_from_json(json, "x")) == json);
  CHECK(html.find("The guide to the view was shown 2 times, for 1.5 s of 4.0 s.") != std::string::npos);
  CHECK(html.find("The guide to the view was used in 2 of 2 steps") != std::string::npos);

  INFO("without it a result is what earlier versions wrote, and the points are the same with it");
  const std::string unguided = to_json(guided({}));
  CHECK(unguided.find("guide") == std::string::npos);
  for (StepResult& step : result.steps) step.guide_times = 0, step.guide_s = 0;
  CHECK(to_json(result) == unguided);
}
