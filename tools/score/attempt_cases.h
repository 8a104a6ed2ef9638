#pragma once

#include <optional>
#include <string>

#include "scenarios/scenario.h"
#include "scenarios/scenario_check.h"
#include "sim/files/files.h"
#include "tools/cli/subject.h"

namespace insonate {

/// Returns the named patient, or else the scenario's own.
inline Case case_of(const Scenario& scenario, const std::filesystem::path& named,
                    const Progress& progress = show_progress) {
  return named.empty() ? load_case(scenario, assets_folder(), cache_folder(), progress) : open_case(named);
}

/// Loads the cases of attempts or of a scenario's variants. Caches the last one, because the same case often follows.
class AttemptCases {
public:
  /// @param patient  Attempt::patient
  const Case& of(const std::string& patient, const Scenario& scenario, const Progress& progress = show_progress) {
    const std::string key = key_of(patient, scenario);
    if (!case_ || key != key_) {
      case_.reset();  // frees the memory before the next case is loaded
      case_ = case_of(scenario, patient, progress);
      key_ = key;
    }
    return *case_;
  }

  /// Returns a text that is equal for equal patients.
  static std::string key_of(const std::string& patient, const Scenario& scenario) {
    return patient.empty() ? patient_key(scenario) : patient;
  }

private:
  std::string key_;
  std::optional<Case> case_;
};

}  // namespace insonate
