#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace insonate {

/// What a writer says it has committed, once the call that commits it has returned.
struct Promise {
  std::int32_t what = 0;
  std::int32_t number = 0;
};
using Promises = std::vector<Promise>;
using Commit = std::function<void(Promise)>;

/// What goes wrong for a process. It is killed after so many microseconds, or when it asks the system for its n-th
/// service, counted over all of its threads. The service is not rendered then. So a kill lands between any two of the
/// steps that other processes can see. Or its files may have so many bytes at most, as on a full disk. Or it may have
/// so many files open at once.
struct Fault {
  enum class Kind { none, time, call, file_size, open_files } kind = Kind::none;
  long at = 0;
};

struct RunOutcome {
  Promises promises;
  bool killed = false;    ///< false: it ended by itself
  int exit_code = 0;      ///< of one that did: 0, 2 if it threw an InputError, anything else for another failure
  std::string said = {};  ///< what it threw
  long calls = 0;         ///< that it made, if they were counted
  long duration_us = 0;
};

/// Runs `work` in a process of its own, under a fault. The caller must have no threads.
RunOutcome run_under(Fault fault, const std::function<void(const Commit&)>& work);

/// Runs `work` in a process of its own to its end. Returns what it threw; empty when it threw nothing.
std::string run_apart(const std::function<void()>& work);

/// The same for a program that may be killed after a time. Its output goes to a file.
RunOutcome run_program_under(Fault fault, const std::vector<std::string>& command, const std::filesystem::path& output);

/// Whether this system lets one process count another's calls.
bool can_count_calls();

}  // namespace insonate
