#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace insonate::fuzz {

/// One reader of bytes from outside. Each source of a target defines one as a static object:
///
///     const Target target("roster", [](std::string_view bytes) -> std::string {
///       const auto ids = read_roster(file_with("roster.csv", bytes));
///       return ids.empty() ? "a roster without learners was taken" : "";
///     });
struct Target {
  /// Returns what is broken of the promises that the reader makes of any bytes, empty when nothing is. May throw
  /// InputError.
  using Promises = std::function<std::string(std::string_view bytes)>;

  Target(std::string called, Promises kept);
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  const std::string name;  ///< also of its corpus
  const Promises promises;
};

/// All targets that are linked, in no particular order.
const std::vector<const Target*>& targets();

/// Returns what is broken when `use` runs: what it returns, or what makes an InputError unfit to be shown. Every other
/// exception passes: it is a finding.
std::string broken_by(const std::function<std::string()>& use);

/// Writes a file into a folder of this process, which is removed when the process ends, and returns its path.
std::filesystem::path file_with(const std::string& name, std::string_view bytes);

}  // namespace insonate::fuzz
