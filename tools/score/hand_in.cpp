#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "devices/sequence/probe_samples.h"
#include "devices/sequence/sequence.h"
#include "scenarios/results/database/results_database.h"
#include "scenarios/runner.h"
#include "sim/core/input_error.h"
#include "sim/files/digest.h"
#include "sim/files/files.h"
#include "tools/score/attempt_cases.h"
#include "tools/score/commands.h"

namespace insonate {
namespace {

/// Scores a sitting as an exam that ends where its log ends.
Attempt scored(ResultsDatabase& database, const Sitting& sitting, AttemptCases& cases, const TissueTable& tissues) {
  const std::string name = "sitting " + std::to_string(sitting.number);
  if (digest_of(sitting.scenario_text) != sitting.scenario_digest)
    throw InputError(database.file().string(), name, "its scenario is damaged", "remove it with --discard");
  const Scenario scenario = parse_scenario(sitting.scenario_text, sitting.scenario_file, sitting.seed);
  std::vector<ProbeSample> samples;
  std::map<double, std::string> actions;
  for (const std::string& part : database.parts(sitting.number)) {
    const Sequence log = parse_sequence(part, name);
    const std::vector<ProbeSample> some = probe_samples(log);
    samples.insert(samples.end(), some.begin(), some.end());
    actions.merge(recorded_actions(log));
  }
  const ActionLog done = parse_action_log(actions, name);
  Runner runner(scenario, cases.of(sitting.patient, scenario), tissues);
  runner.feed(samples, done);
  runner.end();
  ExamResult result = runner.result();
  result.provenance.mode = AttemptMode::exam;
  Attempt attempt = attempt_of(runner, result, write_sequence(samples, actions));
  attempt.learner = sitting.learner;
  attempt.finished_ms = sitting.kept_ms;
  attempt.patient = sitting.patient;
  return attempt;
}

struct HandInRequest {
  std::filesystem::path database;
  std::int64_t sitting = 0;
  bool discard = false;
};

int hand_in(const HandInRequest& given) {
  ResultsDatabase database = ResultsDatabase::open(given.database);
  const TissueTable tissues = read_tissue_table(assets_folder() / "tissues.toml");
  AttemptCases cases;
  bool found = false, all_well = true;
  for (const Sitting& sitting : database.sittings()) {
    if (given.sitting != 0 && sitting.number != given.sitting) continue;
    found = true;
    std::printf("sitting %lld, %s, begun %s: ", static_cast<long long>(sitting.number), sitting.learner.c_str(),
                utc_time(sitting.began_ms).c_str());
    // The age means nothing if the clock was set back.
    const std::int64_t age_ms = now_since_1970_ms() - sitting.kept_ms;
    if (age_ms >= 0 && age_ms < Sitting::kGivenUpAfter_ms) {
      std::printf("under way, or broken off only just\n");
    } else if (given.discard) {
      database.remove(sitting.number);
      std::printf("removed\n");
    } else {
      try {
        Attempt attempt = scored(database, sitting, cases, tissues);
        database.add(attempt, sitting.number);
        std::printf("attempt %lld, %s\n", static_cast<long long>(attempt.number), sitting.title.c_str());
      } catch (const InputError& error) {
        std::printf("%s\n", error.what());
        all_well = false;
      }
    }
  }
  if (!found && given.sitting != 0)
    throw InputError(given.database.string(), "", "there is no sitting " + std::to_string(given.sitting),
                     "list them with 'insonate-score attempts'");
  if (!found) std::printf("no exam was begun and not handed in\n");
  return all_well ? 0 : 2;
}

}  // namespace

void add_hand_in_command(CLI::App& arguments, CommandRun& run) {
  const auto given = std::make_shared<HandInRequest>();
  CLI::App* command = arguments.add_subcommand("hand-in",
                                               "Score the exams that were begun with `insonate exam` but never handed "
                                               "in, for example after a power failure, and store each as an attempt");
  command->add_option("DATABASE", given->database, "Use this database of results")->type_name("FILE")->required();
  CLI::Option* only =
      command->add_option("--sitting", given->sitting, "Use only the exam with this number")->type_name("NUMBER");
  only->check(CLI::PositiveNumber);
  command->add_flag("--discard", given->discard, "Remove the exam unscored, so that the learner can take it again")
      ->needs(only);
  command->callback([given, &run] { run = [given] { return hand_in(*given); }; });
}

}  // namespace insonate
