#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "app/replay/replay.h"
#include "app/session/loaded_case.h"

namespace insonate {

/// Which run is to be looked at again, and which expert's beside it: each a recorded scan or an attempt out of a
/// database of results, which is only read.
struct ReplaySource {
  std::filesystem::path log, beside_log;
  std::filesystem::path database;
  std::int64_t attempt = 0, beside_attempt = 0;  ///< their numbers there; 0 for none

  bool any() const { return !log.empty() || attempt > 0; }
};

/// A replay with the patient and the scenario that it is seen with.
struct LoadedReplay {
  std::shared_ptr<const LoadedCase> loaded_case;
  std::unique_ptr<Replay> replay;
};

/// Loads it all. An attempt brings its own scenario, variant and patient along, in place of what `loaded_case` names.
/// Throws InputError, also when the two runs are of different scenarios: their steps could not be laid beside each
/// other.
LoadedReplay load_replay(const ReplaySource& source, CaseSource loaded_case, const LoadProgress& progress);

}  // namespace insonate
