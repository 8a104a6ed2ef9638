#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace insonate {

/// Runs a program under test without the privileges that would open files its user may not open.
class ChildProcess {
public:
  /// @param settings  "NAME=value", added to this program's own environment
  explicit ChildProcess(const std::vector<std::string>& command, const std::vector<std::string>& settings = {});
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Reads what was written since the last call.
  void listen();
  bool ended();
  /// Returns the exit code, 128 or above for a signal. To be called once the program has ended.
  int exit_code() const { return exit_code_; }
  /// Returns the process id; negative once the program has ended.
  pid_t pid() const { return pid_; }

  std::string out, err;

private:
  pid_t pid_ = -1;
  int exit_code_ = 0;
  int out_fd_ = -1, err_fd_ = -1;
};

}  // namespace insonate
