#include "app/replay/replay_source.h"

#include <optional>
#include <string>
#include <utility>

#include "devices/replay/read_log.h"
#include "scenarios/result_json.h"
#include "scenarios/results/database/results_database.h"
#include "sim/core/input_error.h"

namespace insonate {
namespace {

struct KeptRun {
  RecordedScan scan;
  std::optional<Scenario> scenario;  ///< of an attempt; a log contains no scenario
  std::string patient;               ///< of an attempt that did not use the scenario's own case
};

KeptRun kept_attempt(const std::filesystem::path& database, std::int64_t number) {
  const Attempt attempt = ResultsDatabase::open(database).read(number);
  const std::string name = "attempt " + std::to_string(number);
  const Sequence log = parse_sequence(attempt.log, name);
  KeptRun run;
  run.scan = recorded_scan(log);
  const std::uint32_t seed = result_from_json(attempt.score_json, name).provenance.seed;
  run.scenario = parse_scenario(attempt.scenario_text, attempt.scenario_file, seed);
  run.patient = attempt.patient;
  parse_action_log(run.scan.recording.actions, name);
  return run;
}

KeptRun kept_run(const std::filesystem::path& log, const std::filesystem::path& database, std::int64_t attempt) {
  if (attempt > 0) return kept_attempt(database, attempt);
  KeptRun run;
  run.scan = read_log(log);
  check_is_of_probe(run.scan.recording);
  parse_action_log(run.scan.recording.actions, run.scan.recording.file);  // check before the slow creation of a patient
  return run;
}

bool has_any(const std::filesystem::path& log, std::int64_t attempt) {
  return !log.empty() || attempt > 0;
}

}  // namespace

std::string recorded_patient(const std::filesystem::path& log) {
  try {
    return recorded_patient(read_log(log).recording);
  } catch (const InputError&) {
    return "";
  }
}

LoadedReplay load_replay(const ReplaySource& source, CaseSource case_source, const LoadProgress& progress) {
  const KeptRun run = kept_run(source.log, source.database, source.attempt);
  std::optional<KeptRun> expert;
  if (has_any(source.beside_log, source.beside_attempt))
    expert = kept_run(source.beside_log, source.database, source.beside_attempt);
  if (run.scenario) {
    if (expert && expert->scenario && expert->scenario->digest != run.scenario->digest)
      throw InputError(source.database.string(), expert->scan.recording.file,
                       "it is of another scenario than " + run.scan.recording.file,
                       "lay an attempt at the same scenario beside it");
    case_source = {};
    case_source.ct = run.patient;
    case_source.kept = run.scenario;
  }
  LoadedCase patient = load_case(case_source, progress);
  // An attempt in a database keeps its own patient.
  if (!run.scenario) check_recorded_on(patient, run.scan.recording);
  if (expert && !expert->scenario) check_recorded_on(patient, expert->scan.recording);
  if (source.without_steps && !run.scenario) patient.scenario.reset();
  LoadedReplay loaded;
  loaded.loaded_case = std::make_shared<const LoadedCase>(std::move(patient));
  const auto play = [&](const KeptRun& kept, const std::string& what) {
    return play_through(loaded.loaded_case, kept.scan, [&](double share) { progress(what, share); });
  };
  RecordedRun played = play(run, "Going through the run");
  std::optional<RecordedRun> beside;
  if (expert) beside = play(*expert, "Going through the expert's run");
  loaded.replay = std::make_unique<Replay>(std::move(played), std::move(beside));
  return loaded;
}

}  // namespace insonate
