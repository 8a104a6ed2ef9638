#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace insonate {

/// A program under test, without the privileges that would open what its user may not.
class ChildProcess {
public:
  /// @param settings  of its environment, "NAME=value", above this program's own
  explicit ChildProcess(const std::vector<std::string>& command, const std::vector<std::string>& settings = {});
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Takes what was written since the last call.
  void listen();
  bool ended();
  /// 128 and above for a signal. Call it once it has ended.
  int exit_code() const { return exit_code_; }
  /// Below 0 once it has ended.
  pid_t pid() const { return pid_; }

  std::string out, err;

private:
  pid_t pid_ = -1;
  int exit_code_ = 0;
  int out_fd_ = -1, err_fd_ = -1;
};

}  // namespace insonate
