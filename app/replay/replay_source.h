#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "app/replay/replay.h"
#include "app/session/loaded_case.h"

namespace insonate {

/// Names the run to replay and the expert's run beside it. Each is a recorded scan or an attempt in a results database,
/// which is only read.
struct ReplaySource {
  std::filesystem::path log, beside_log;
  std::filesystem::path database;
  std::int64_t attempt = 0, beside_attempt = 0;  ///< their numbers in the database; 0 for none
  bool without_steps = false;                    ///< of a log: it is not measured against the scenario

  bool any() const { return !log.empty() || attempt > 0; }
};

/// Returns whom a log names as its patient (LoadedCase::patient); empty if it names nobody or cannot be read.
std::string recorded_patient(const std::filesystem::path& log);

/// A replay with its patient and scenario.
struct LoadedReplay {
  std::shared_ptr<const LoadedCase> loaded_case;
  std::unique_ptr<Replay> replay;
};

/// Loads the runs, the patient and the scenario. An attempt brings its own scenario, variant and patient, which replace
/// those that `loaded_case` names. Throws InputError, also if `log` names another patient than `loaded_case`, and if
/// the two runs belong to different scenarios: their steps could not be aligned.
LoadedReplay load_replay(const ReplaySource& source, CaseSource loaded_case, const LoadProgress& progress);

}  // namespace insonate
