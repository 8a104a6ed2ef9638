#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/faults/killed_process.h"

namespace insonate {

/// One kind of output whose writer may be killed, and the conditions that must hold afterwards. The parent process
/// calls only the constructor: write() and check() run in subprocesses.
class Kind {
public:
  explicit Kind(std::string written) : what(std::move(written)) {}
  virtual ~Kind() = default;
  Kind(const Kind&) = delete;
  Kind& operator=(const Kind&) = delete;

  /// Starts with what earlier writers left in the folder, as the programs do, writes for a while, and ends.
  /// @param before  what the earlier writers have committed
  virtual void write(const std::filesystem::path& folder, const Promises& before, const Commit& commit) = 0;

  /// Throws if anything committed is lost, if something half written looks complete, if it cannot be continued, or if
  /// leftover files do not follow the rules.
  virtual void check(const std::filesystem::path& folder, const Promises& promises) = 0;

  /// Returns a program to run in place of write(); empty for none.
  virtual std::vector<std::string> command(const std::filesystem::path&, int /*round*/) { return {}; }

  const std::string what;  ///< what is written, in words
};

std::vector<std::unique_ptr<Kind>> library_kinds();
/// Adds the kinds that write into folders. library_kinds() has them too.
void add_folder_kinds(std::vector<std::unique_ptr<Kind>>& kinds);
/// Returns the kinds that run programs. Their scratch files come from `made`, a folder that must outlive them.
std::vector<std::unique_ptr<Kind>> program_kinds(const std::filesystem::path& made);

}  // namespace insonate
