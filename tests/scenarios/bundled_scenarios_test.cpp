#include <catch2/catch.hpp>

#include <algorithm>
#include <map>
#include <set>

#include "devices/sequence/probe_samples.h"
#include "scenarios/result_json.h"
#include "scenarios/runner.h"
#include "sim/files/files.h"

using namespace insonate;

namespace {

const std::filesystem::path kAssets = INSONATE_ASSETS_FOLDER;

const TissueTable& tissues() {
  static const TissueTable table = read_tissue_table(kAssets / "tissues.toml");
  return table;
}

/// A bundled scenario on a phantom of 3 mm voxels, which is made in seconds.
struct Bundled {
  Scenario scenario;
  Case subject;

  explicit Bundled(Scenario drawn) : scenario(std::move(drawn)) {
    scenario.phantom_options.emplace_back("voxel_mm", "3");
    subject = load_case(scenario, kAssets, cache_folder());
  }

  ExamResult score(const std::string& log) const {
    const RecordedScan scan = read_recorded_scan(kAssets / "logs" / log);
    Runner runner(scenario, subject, tissues());
    runner.feed(scan.samples, parse_action_log(scan.recording.actions, log));
    runner.end();
    return runner.result();
  }
};

/// Each variant of a scenario, as the first seed draws it that does.
std::map<std::string, Scenario> variants_of(const std::filesystem::path& file) {
  std::map<std::string, Scenario> drawn;
  for (std::uint32_t seed = 0; drawn.size() < std::max<std::size_t>(read_scenario(file).variants, 1); ++seed) {
    REQUIRE(seed < 1000);
    Scenario scenario = read_scenario(file, seed);
    drawn.emplace(scenario.variant, std::move(scenario));
  }
  return drawn;
}

/// Adds up what a result measures and scores. A change of any of it changes the sum.
double sum_of(const ExamResult& result) {
  const auto of_motion = [](const MotionValues& motion) {
    return motion.time_s + motion.path_length_mm + motion.angular_path_deg + motion.translational_movements +
           motion.rotational_movements + motion.tracked_s + motion.on_skin_s + motion.untracked_s + motion.dropouts +
           motion.log_dimensionless_jerk.value_or(0) + motion.spectral_arc_length.value_or(0);
  };
  double sum = result.points + of_motion(result.motion);
  for (const CriterionScore& criterion : result.criteria) sum += criterion.points;
  for (const StepResult& step : result.steps) {
    sum += step.end_s + step.longest_hold_s + of_motion(step.motion);
    if (step.judged)
      for (const ViewValues::Field& field : ViewValues::fields()) sum += *step.judged.*field.value;
    for (const auto& [metric, value] : step.values) sum += value;
    for (const CriterionScore& criterion : step.criteria) sum += criterion.points;
  }
  return sum;
}

/// The bundled scenarios with logs of their own, and the variants that these were made for.
struct Row {
  std::string name;
  std::string variant;
  double good_sum, poor_sum;  ///< sum_of() of the logs' results
};
const std::vector<Row> kRows{{"knobs", "feet", 1198.92490862, 1346.19486658},
                             {"gallbladder", "stone", 2048.96126804, 1367.44625685},
                             {"aorta", "aneurysm", 2482.52567403, 2423.29480496},
                             {"fast", "fluid in the left upper quadrant", 5921.99976069, 5882.45532318},
                             {"kidneys", "stone on the right", 6245.36545093, 4620.00886015},
                             {"liver_sweep", "cyst", 3813.99602821, 2829.32271765},
                             {"bladder_volume", "retention", 1847.88382604, 1349.45032107}};

std::filesystem::path file_of(const Row& row) {
  return kAssets / "scenarios" / (row.name + ".toml");
}

bool fails_by(const ExamResult& result, const std::string& kind) {
  return std::any_of(result.steps.begin(), result.steps.end(), [&](const StepResult& step) {
    return step.kind == kind && std::any_of(step.criteria.begin(), step.criteria.end(),
                                            [](const CriterionScore& m) { return m.fails_exam(); });
  });
}

}  // namespace

TEST_CASE("of each scenario's bundled logs the good one passes, the poor one fails and is nowhere better") {
  for (const Row& row : kRows) {
    const Bundled bundled(variants_of(file_of(row)).at(row.variant));
    const ExamResult good = bundled.score(row.name + "_good.igs.mha");
    const ExamResult poor = bundled.score(row.name + "_poor.igs.mha");
    INFO(to_json(good) << to_json(poor));
    // A change of either sum needs a new ExamResult::kScoringVersion.
    CHECK(sum_of(good) == Approx(row.good_sum).epsilon(1e-9));
    CHECK(sum_of(poor) == Approx(row.poor_sum).epsilon(1e-9));
    CHECK(good.passed);
    CHECK(good.percent > 90);
    CHECK_FALSE(poor.passed);
    CHECK(poor.percent < 50);
    const auto compare = [](const std::vector<CriterionScore>& better, const std::vector<CriterionScore>& worse) {
      for (std::size_t k = 0; k < std::min(better.size(), worse.size()); ++k)
        CHECK(worse[k].points <= better[k].points);
    };
    for (std::size_t i = 0; i < good.steps.size(); ++i) compare(good.steps[i].criteria, poor.steps[i].criteria);
    compare(good.criteria, poor.criteria);
  }
}

TEST_CASE("who finds what is not there fails: a good log passes with no other variant's patient") {
  for (const Row& row : kRows)
    for (const auto& [name, scenario] : variants_of(file_of(row))) {
      if (name == row.variant) continue;
      CAPTURE(row.name, name);
      const ExamResult result = Bundled(scenario).score(row.name + "_good.igs.mha");
      INFO(to_json(result));
      CHECK_FALSE(result.passed);
      CHECK(fails_by(result, "question"));
    }
}

TEST_CASE("the bundled scenarios fit the built-in patient in each variant, and no fixed answers are right in two") {
  for (const auto& entry : std::filesystem::directory_iterator(kAssets / "scenarios")) {
    std::set<std::vector<std::string>> right;
    for (const auto& [name, scenario] : variants_of(entry.path())) {
      // What is right does not hang on the scan: questions get some answer, and all else is passed over.
      const Bundled bundled(scenario);
      Runner runner(bundled.scenario, bundled.subject, tissues());
      for (double time_s = 0; !runner.live().finished; time_s += 0.1) {
        const bool asked = scenario.steps[runner.live().step].kind == "question";
        ProbeSample sample;
        sample.time_s = time_s;
        runner.feed(sample, std::vector{asked ? Action{ActionKind::answer, {}, "?"} : Action{ActionKind::go_on}});
      }
      std::vector<std::string> answers;
      for (const StepResult& step : runner.result().steps)
        for (const auto& [fact, value] : step.facts)
          if (fact == "right answer") answers.push_back(value);
      CAPTURE(entry.path(), name);
      CHECK(right.insert(answers).second);
      // And a wrong answer alone fails.
      for (const Step& step : scenario.steps)
        if (step.kind == "question")
          CHECK(std::any_of(step.criteria.begin(), step.criteria.end(),
                            [](const Criterion& criterion) { return criterion.critical; }));
    }
  }
}
