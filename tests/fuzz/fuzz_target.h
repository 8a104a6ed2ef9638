#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace insonate::fuzz {

/// A fuzz target for one reader of external bytes. Each source file of a target defines one as a static object:
///
///     const Target target("roster", [](std::string_view bytes) -> std::string {
///       const auto ids = read_roster(file_with("roster.csv", bytes));
///       return ids.empty() ? "a roster without learners was taken" : "";
///     });
struct Target {
  /// Returns which promise the reader breaks for these bytes; empty if none. May throw InputError.
  using Promises = std::function<std::string(std::string_view bytes)>;

  Target(std::string called, Promises kept);
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  const std::string name;  ///< also the name of its corpus
  const Promises promises;
};

/// Returns all linked targets, in no particular order.
const std::vector<const Target*>& targets();

/// Runs `use` and returns what is broken: its result, or why an InputError that it threw is unfit to be shown. Every
/// other exception passes through, because it is a finding.
std::string broken_by(const std::function<std::string()>& use);

/// Writes a file into a temporary folder of this process and returns its path. The folder is removed when the process
/// ends.
std::filesystem::path file_with(const std::string& name, std::string_view bytes);

}  // namespace insonate::fuzz
