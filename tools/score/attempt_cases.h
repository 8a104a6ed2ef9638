#pragma once

#include <optional>
#include <string>

#include "scenarios/scenario.h"
#include "sim/core/files.h"
#include "tools/cli/subject.h"

namespace insonate {

/// The patient that was named, or else the scenario's own.
inline Case case_of(const Scenario& scenario, const std::filesystem::path& named,
                    const Progress& progress = show_progress) {
  return named.empty() ? load_case(scenario, assets_folder(), cache_folder(), progress) : open_case(named);
}

/// The cases that attempts were taken on, or that a scenario's variants ask for, the last one kept: the same often
/// comes again at once.
class AttemptCases {
public:
  /// @param patient  Attempt::patient
  const Case& of(const std::string& patient, const Scenario& scenario, const Progress& progress = show_progress) {
    const std::string key = key_of(patient, scenario);
    if (!case_ || key != key_) {
      case_.reset();  // two would take twice the memory
      case_ = case_of(scenario, patient, progress);
      key_ = key;
    }
    return *case_;
  }

  /// The same text for the same patient.
  static std::string key_of(const std::string& patient, const Scenario& scenario) {
    if (!patient.empty()) return patient;
    std::string key = '\n' + scenario.case_name + '\n' + scenario.file.parent_path().string();
    for (const auto& [name, value] : scenario.phantom_options) key.append("\n").append(name).append("=").append(value);
    return key;
  }

private:
  std::string key_;
  std::optional<Case> case_;
};

}  // namespace insonate
