#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/faults/killed_process.h"

namespace insonate {

/// One thing that is written while somebody may kill the writer, and what has to hold after that. The parent process
/// calls nothing of it but the constructor: write() and check() run in processes of their own.
class Kind {
public:
  explicit Kind(std::string written) : what(std::move(written)) {}
  virtual ~Kind() = default;
  Kind(const Kind&) = delete;
  Kind& operator=(const Kind&) = delete;

  /// Starts on what earlier writers left in the folder, as the programs do, writes for a while, and ends.
  /// @param before  what they have committed
  virtual void write(const std::filesystem::path& folder, const Promises& before, const Commit& commit) = 0;

  /// Throws when anything committed is lost, when something half written looks whole, when it cannot
  /// be gone on with, or when what was left behind does not go by the rule.
  virtual void check(const std::filesystem::path& folder, const Promises& promises) = 0;

  /// A program to run in place of write(); empty for none.
  virtual std::vector<std::string> command(const std::filesystem::path&, int /*round*/) { return {}; }

  const std::string what;  ///< that is written, in words
};

std::vector<std::unique_ptr<Kind>> library_kinds();
/// Their scratch files come from `made`, a folder that lasts as long as they do.
std::vector<std::unique_ptr<Kind>> program_kinds(const std::filesystem::path& made);

}  // namespace insonate
