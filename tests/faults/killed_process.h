#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace insonate {

/// Reports that a writer has committed something, sent once the call that commits it has returned.
struct Promise {
  std::int32_t what = 0;
  std::int32_t number = 0;
};
using Promises = std::vector<Promise>;
using Commit = std::function<void(Promise)>;

/// A fault of a process. The process may be killed after a number of microseconds, or at its n-th system call, counted
/// over all of its threads; that call is not executed. So the kill can fall between any two steps that other processes
/// can see. Or the size of its files may be limited, as on a full disk. Or the number of open files may be limited.
struct Fault {
  enum class Kind { none, time, call, file_size, open_files } kind = Kind::none;
  long at = 0;
};

struct RunOutcome {
  Promises promises;
  bool killed = false;  ///< false: it ended by itself
  int exit_code = 0;    ///< of a process that ended: 0, 2 if it threw an InputError, anything else for another failure
  std::string said = {};  ///< what it threw
  long calls = 0;         ///< number of its system calls, if they were counted
  long duration_us = 0;
};

/// Runs `work` in a subprocess, under a fault. The caller must have no threads.
RunOutcome run_under(Fault fault, const std::function<void(const Commit&)>& work);

/// Runs `work` to its end in a subprocess. Returns what it threw; empty if it threw nothing.
std::string run_in_child(const std::function<void()>& work);

/// Does the same for a program that may be killed after a time. Its output goes to a file.
RunOutcome run_program_under(Fault fault, const std::vector<std::string>& command, const std::filesystem::path& output);

/// Returns whether this system lets one process count another's system calls.
bool can_count_calls();

}  // namespace insonate
