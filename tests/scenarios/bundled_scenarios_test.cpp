#include <catch2/catch.hpp>

#include <map>
#include <set>

#include "devices/sequence/probe_samples.h"
#include "scenarios/result_json.h"
#include "scenarios/runner.h"
#include "sim/core/files.h"

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

  Bundled(const std::filesystem::path& file, std::uint32_t seed) : scenario(read_scenario(file, seed)) {
    scenario.phantom_options.emplace_back("voxel_mm", "3");
    subject = load_case(scenario, kAssets, cache_folder());
  }
};

ExamResult score(const char* scenario, std::uint32_t seed, const std::string& log) {
  const Bundled bundled(kAssets / "scenarios" / scenario, seed);
  const RecordedScan scan = read_recorded_scan(kAssets / "logs" / log);
  Runner runner(bundled.scenario, bundled.subject, tissues());
  runner.feed(scan.samples, parse_action_log(scan.recording.actions, log));
  runner.end();
  return runner.result();
}

}  // namespace

TEST_CASE("the bundled scenarios fit the built-in patient, with each variant that a seed may draw") {
  for (const auto& entry : std::filesystem::directory_iterator(kAssets / "scenarios")) {
    CAPTURE(entry.path());
    std::set<std::string> seen;
    for (std::uint32_t seed = 0; seen.size() < std::max<std::size_t>(read_scenario(entry.path()).variants, 1); ++seed) {
      REQUIRE(seed < 1000);
      if (!seen.insert(read_scenario(entry.path(), seed).variant).second) continue;
      const Bundled bundled(entry.path(), seed);
      CHECK_NOTHROW(Runner(bundled.scenario, bundled.subject, tissues()));
    }
  }
}

TEST_CASE("of each scenario's bundled logs the good one passes, the poor one fails and is nowhere better") {
  struct Row {
    const char* scenario;
    std::uint32_t seed;  ///< the one its logs were made for
    std::string name;
  };
  for (const Row& row :
       {Row{"knobs.toml", 0, "knobs"}, Row{"gallbladder.toml", 2, "gallbladder"}, Row{"aorta.toml", 0, "aorta"}}) {
    const ExamResult good = score(row.scenario, row.seed, row.name + "_good.igs.mha");
    const ExamResult poor = score(row.scenario, row.seed, row.name + "_poor.igs.mha");
    INFO(to_json(good) << to_json(poor));
    CHECK(good.passed);
    CHECK(good.percent > 90);
    CHECK_FALSE(poor.passed);
    CHECK(poor.percent < 50);
    for (std::size_t i = 0; i < good.steps.size(); ++i)
      for (std::size_t k = 0; k < std::min(good.steps[i].marks.size(), poor.steps[i].marks.size()); ++k)
        CHECK(poor.steps[i].marks[k].points <= good.steps[i].marks[k].points);
  }
}

TEST_CASE("who answers without the finding being there fails: the log of a stone does not pass without one") {
  // Seed 0 draws the patient without a stone, on whom the same hand sees the same organ.
  const ExamResult result = score("gallbladder.toml", 0, "gallbladder_good.igs.mha");
  INFO(to_json(result));
  CHECK(result.provenance.variant == "no stone");
  CHECK_FALSE(result.passed);
  CHECK(result.steps.back().marks[0].points == 0);
}
