#include <catch2/catch.hpp>

#include <algorithm>

#include "devices/replay/replay_tracker.h"
#include "devices/sequence/probe_samples.h"
#include "scenarios/report/report.h"
#include "scenarios/result_json.h"
#include "scenarios/runner.h"
#include "sim/files/files.h"

using namespace insonate;

namespace {

const std::filesystem::path kAssets = INSONATE_ASSETS_FOLDER;

/// The bundled exam on a phantom of 2 mm voxels, which is made in seconds; what is tested here does not hang on finer
/// ones, because the marks' limits are wider than 2 mm.
struct BundledExam {
  Scenario scenario = coarse(read_scenario(kAssets / "scenarios" / "ruq_hepatorenal.toml"));
  Case subject = load_case(scenario, kAssets, cache_folder());
  TissueTable tissues = read_tissue_table(kAssets / "tissues.toml");

  static Scenario coarse(Scenario scenario) {
    scenario.phantom_options.emplace_back("voxel_mm", "2");
    return scenario;
  }

  ExamResult score(const std::vector<ProbeSample>& samples) const {
    Runner runner(scenario, subject, tissues);
    runner.feed(samples);
    runner.end();
    return runner.result();
  }

  /// As the trainer does: a replay at some speed, polled once a frame.
  ExamResult replay(const std::vector<ProbeSample>& log, double speed, double frames_hz) const {
    ReplayTracker tracker("log", log, {speed, false});
    Runner runner(scenario, subject, tissues);
    for (int frame = 0; tracker.state().condition != TrackerCondition::finished; ++frame) {
      std::vector<ProbeSample> samples;
      tracker.poll(1000.0 + frame / frames_hz, samples);
      runner.feed(samples);
    }
    runner.end();
    return runner.result();
  }
};

std::vector<ProbeSample> log(const char* name) {
  return read_recorded_scan(kAssets / "logs" / name).samples;
}

bool any_contains(const std::vector<std::string>& reasons, const std::string& words) {
  return std::any_of(reasons.begin(), reasons.end(),
                     [&](const std::string& reason) { return reason.find(words) != std::string::npos; });
}

}  // namespace

TEST_CASE(
    "of the bundled logs the good one passes the bundled exam and the poor one fails, for reasons that are named") {
  const BundledExam exam;
  const ExamResult good = exam.score(log("ruq_good.igs.mha"));
  INFO(to_json(good));
  CHECK(good.passed);
  CHECK(good.percent > 90);
  for (const StepResult& step : good.steps) CHECK(step.outcome == StepOutcome::held);
  CHECK(good.motion.time_s > 20);  // no view was met on the way by chance
  CHECK(good.motion.dropouts > 0);

  const ExamResult poor = exam.score(log("ruq_poor.igs.mha"));
  INFO(to_json(poor));
  CHECK_FALSE(poor.passed);
  CHECK(poor.percent < 50);
  CHECK(any_contains(poor.reasons, "80 % are needed"));
  CHECK(any_contains(poor.reasons, "before the view was held long enough"));
  CHECK(any_contains(poor.reasons, "critical: Target reached by the sound"));
  CHECK(any_contains(poor.reasons, "Distance of the target from the plane"));
  CHECK(any_contains(poor.reasons, "Time without tracking"));
  CHECK(poor.motion.dropouts > good.motion.dropouts);

  // On no criterion that it is worse in does the poor scan outscore the good one.
  const auto compare = [](const std::vector<CriterionScore>& better, const std::vector<CriterionScore>& worse) {
    for (std::size_t i = 0; i < better.size(); ++i) CHECK(worse[i].points <= better[i].points);
  };
  for (std::size_t i = 0; i < good.steps.size(); ++i) compare(good.steps[i].criteria, poor.steps[i].criteria);
  compare(good.criteria, poor.criteria);
}

TEST_CASE("a log's score is the same to the bit at any replay speed and frame rate") {
  const BundledExam exam;
  const std::vector<ProbeSample> samples = log("ruq_good.igs.mha");
  const std::string offline = to_json(exam.score(samples));
  CHECK(to_json(exam.replay(samples, 1.0, 60)) == offline);
  CHECK(to_json(exam.replay(samples, 7.3, 17)) == offline);
}

TEST_CASE("the bundled logs are as a tracker makes them: small, with lost frames") {
  for (const char* name : {"ruq_good.igs.mha", "ruq_poor.igs.mha"}) {
    CHECK(std::filesystem::file_size(kAssets / "logs" / name) < 1u << 20);
    const std::vector<ProbeSample> samples = log(name);
    CHECK(samples.back().time_s - samples.front().time_s >= 40);
    CHECK(samples.back().time_s - samples.front().time_s <= 70);
    const auto lost =
        std::count_if(samples.begin(), samples.end(), [](const ProbeSample& s) { return s.status != PoseStatus::ok; });
    CHECK(lost > 0);
    CHECK(lost < long(samples.size()) / 5);
  }
}
