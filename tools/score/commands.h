#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/results/database/results_database.h"

// The commands of insonate-score, except scoring.

namespace insonate {

/// Runs the given command and returns the exit code. Empty if none was given.
using CommandRun = std::function<int()>;

/// Each function declares its commands on `arguments` and sets `run` when one of them is parsed.
void add_check_command(CLI::App& arguments, CommandRun& run);
void add_comment_command(CLI::App& arguments, CommandRun& run);
void add_export_command(CLI::App& arguments, CommandRun& run);
void add_hand_in_command(CLI::App& arguments, CommandRun& run);
void add_list_commands(CLI::App& arguments, CommandRun& run);
void add_pass_mark_command(CLI::App& arguments, CommandRun& run);
void add_report_command(CLI::App& arguments, CommandRun& run);
void add_rescore_command(CLI::App& arguments, CommandRun& run);

/// Declares --mode: the mode of the attempts to use.
inline CLI::Option* add_mode_option(CLI::App& command, std::string& mode, const std::string& meaning) {
  return command.add_option("--mode", mode, meaning)
      ->type_name("MODE")
      ->check(CLI::IsMember(std::vector<std::string>(kAttemptModes.begin(), kAttemptModes.end())));
}

/// Returns the numbers of all attempts, or only `only` if it is not 0.
inline std::vector<std::int64_t> chosen_attempts(ResultsDatabase& database, std::int64_t only) {
  if (only != 0) return {only};
  std::vector<std::int64_t> numbers;
  for (const AttemptSummary& attempt : database.attempts()) numbers.push_back(attempt.number);
  return numbers;
}

}  // namespace insonate
