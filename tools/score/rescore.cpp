#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "devices/sequence/probe_samples.h"
#include "scenarios/result_json.h"
#include "scenarios/results/database/results_database.h"
#include "scenarios/results/rescoring.h"
#include "scenarios/runner.h"
#include "sim/files/files.h"
#include "tools/score/attempt_cases.h"
#include "tools/score/commands.h"

namespace insonate {
namespace {

/// Returns why the attempt's score differs, or an empty text if it is the same.
std::string compare(ResultsDatabase& database, std::int64_t number, AttemptCases& cases, const TissueTable& tissues) {
  const std::string name = "attempt " + std::to_string(number);
  try {
    const Attempt attempt = database.read(number);
    const std::uint32_t seed = result_from_json(attempt.score_json, name).provenance.seed;
    Scenario scenario = parse_scenario(attempt.scenario_text, attempt.scenario_file, seed);
    const Sequence log = parse_sequence(attempt.log, name);
    const std::vector<ProbeSample> samples = probe_samples(log);
    const ActionLog actions = parse_action_log(recorded_actions(log), name);
    Runner runner(scenario, cases.of(attempt.patient, scenario), tissues);
    runner.feed(samples, actions);
    runner.end();
    return why_different(attempt.score_json, runner.result(), name);
  } catch (const InputError& error) {
    return std::string("it cannot be scored: ") + error.what();
  }
}

struct RescoreRequest {
  std::filesystem::path database;
  std::int64_t attempt = 0;
};

int rescore(const RescoreRequest& given) {
  ResultsDatabase database = ResultsDatabase::open(given.database);
  const TissueTable tissues = read_tissue_table(assets_folder() / "tissues.toml");
  AttemptCases cases;
  int same = 0, other = 0;
  for (const std::int64_t number : chosen_attempts(database, given.attempt)) {
    const std::string why = compare(database, number, cases, tissues);
    std::printf("attempt %lld: %s\n", static_cast<long long>(number), why.empty() ? "the same" : why.c_str());
    ++(why.empty() ? same : other);
  }
  std::printf("%d the same, %d not\n", same, other);
  return other > 0 ? 1 : 0;
}

}  // namespace

void add_rescore_command(CLI::App& arguments, CommandRun& run) {
  const auto given = std::make_shared<RescoreRequest>();
  CLI::App* command = arguments.add_subcommand(
      "rescore",
      "Score the attempts in a database again, each from its own log and scenario, and list which scores are equal to "
      "the last bit and why others are not. The database is not changed. The exit code is 1 if any score differs");
  command->add_option("DATABASE", given->database, "Use this database of results")->type_name("FILE")->required();
  command->add_option("--attempt", given->attempt, "Score only the attempt with this number")
      ->type_name("NUMBER")
      ->check(CLI::PositiveNumber);
  command->callback([given, &run] { run = [given] { return rescore(*given); }; });
}

}  // namespace insonate
