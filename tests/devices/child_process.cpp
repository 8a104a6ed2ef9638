#include "tests/devices/child_process.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <stdexcept>
#include <utility>

extern char** environ;

namespace insonate {

ChildProcess::ChildProcess(const std::vector<std::string>& command, const std::vector<std::string>& settings) {
  std::vector<char*> arguments, variables;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  // Of two equal names the first one counts.
  for (const std::string& setting : settings) variables.push_back(const_cast<char*>(setting.c_str()));
  for (char** setting = environ; *setting; ++setting) variables.push_back(*setting);
  arguments.push_back(nullptr);
  variables.push_back(nullptr);

  int out_pipe[2], err_pipe[2];
  if (pipe2(out_pipe, O_CLOEXEC) != 0 || pipe2(err_pipe, O_CLOEXEC) != 0)
    throw std::runtime_error("no pipe can be made");
  pid_ = fork();
  if (pid_ == 0) {
    dup2(out_pipe[1], STDOUT_FILENO);
    dup2(err_pipe[1], STDERR_FILENO);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE);
    prctl(PR_CAPBSET_DROP, CAP_DAC_READ_SEARCH);
    execve(arguments[0], arguments.data(), variables.data());
    _exit(127);
  }
  close(out_pipe[1]);
  close(err_pipe[1]);
  out_fd_ = out_pipe[0];
  err_fd_ = err_pipe[0];
  for (const int fd : {out_fd_, err_fd_}) fcntl(fd, F_SETFL, O_NONBLOCK);
}

ChildProcess::~ChildProcess() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close(out_fd_);
  close(err_fd_);
}

void ChildProcess::listen() {
  std::array<char, 4096> part;
  for (const auto& [fd, text] : {std::pair{out_fd_, &out}, std::pair{err_fd_, &err}})
    for (ssize_t got = 0; (got = read(fd, part.data(), part.size())) > 0;) text->append(part.data(), std::size_t(got));
}

bool ChildProcess::ended() {
  int status = 0;
  if (pid_ > 0 && waitpid(pid_, &status, WNOHANG) == pid_) {
    pid_ = -1;
    exit_code_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  }
  return pid_ < 0;
}

}  // namespace insonate
