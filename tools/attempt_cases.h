#pragma once

#include <optional>
#include <string>

#include "scenarios/scenario.h"
#include "sim/core/files.h"
#include "tools/subject.h"

namespace insonate {

/// The patient that was named, or else the scenario's own.
inline Case case_of(const Scenario& scenario, const std::filesystem::path& named) {
  return named.empty() ? load_case(scenario, assets_folder(), cache_folder(), show_progress) : open_case(named);
}

/// The cases that attempts were taken on, or that a scenario's variants ask for, the last one kept: the same often
/// comes again at once.
class AttemptCases {
public:
  /// @param patient  Attempt::patient
  const Case& of(const std::string& patient, const Scenario& scenario) {
    std::string key = patient;
    if (patient.empty()) {
      key = '\n' + scenario.case_name + '\n' + scenario.file.parent_path().string();
      for (const auto& [name, value] : scenario.phantom_options)
        key.append("\n").append(name).append("=").append(value);
    }
    if (!case_ || key != key_) {
      case_.reset();  // two would take twice the memory
      case_ = case_of(scenario, patient);
      key_ = key;
    }
    return *case_;
  }

private:
  std::string key_;
  std::optional<Case> case_;
};

}  // namespace insonate
