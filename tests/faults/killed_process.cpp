#include "tests/faults/killed_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <exception>
#include <stdexcept>

#include "sim/core/input_error.h"

namespace insonate {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

/// Waits for the end of `child` until a moment. False when it has not ended by then.
bool ends_by(pid_t child, Clock::time_point moment, int& status) {
  for (;;) {
    if (waitpid(child, &status, WNOHANG) == child) return true;
    if (Clock::now() >= moment) return false;
    usleep(20);
  }
}

std::string all_of(int descriptor) {
  std::string text(4096, '\0');
  std::size_t size = 0;
  for (ssize_t got = 0; (got = read(descriptor, text.data() + size, text.size() - size)) > 0;) size += std::size_t(got);
  text.resize(size);
  return text;
}

void take_end(int status, RunOutcome& outcome) {
  outcome.killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : WIFSIGNALED(status) ? 128 + WTERMSIG(status) : 0;
}

void kill_by_time(pid_t child, long at_us, RunOutcome& outcome) {
  int status = 0;
  if (!ends_by(child, Clock::now() + std::chrono::microseconds(at_us), status)) {
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
  }
  take_end(status, outcome);
}

/// Counts the calls of a child that has stopped itself, and kills it at the `at`-th; 0 lets it go on to its end.
void kill_by_call(pid_t child, long at, RunOutcome& outcome) {
  int status = 0;
  if (waitpid(child, &status, 0) != child || !WIFSTOPPED(status)) fail("the writer did not stop");
  if (ptrace(PTRACE_SETOPTIONS, child, nullptr,
             PTRACE_O_TRACESYSGOOD | PTRACE_O_TRACECLONE | PTRACE_O_TRACEFORK | PTRACE_O_EXITKILL) != 0)
    fail("ptrace");
  ptrace(PTRACE_SYSCALL, child, nullptr, nullptr);
  for (;;) {
    const pid_t thread = waitpid(-1, &status, __WALL);
    if (thread < 0) break;
    if (!WIFSTOPPED(status)) {
      if (thread == child) take_end(status, outcome);
      continue;
    }
    const int signal = WSTOPSIG(status);
    // A call stops twice, on its way in and out.
    if (signal == (SIGTRAP | 0x80) && ++outcome.calls == 2 * at) kill(child, SIGKILL);
    const bool own = signal == (SIGTRAP | 0x80) || signal == SIGTRAP || signal == SIGSTOP;
    ptrace(PTRACE_SYSCALL, thread, nullptr, own ? 0L : long(signal));
  }
  outcome.calls /= 2;
}

/// Forks; the child waits to be traced if its calls are counted.
pid_t start(bool counted) {
  const pid_t child = fork();
  if (child < 0) fail("fork");
  if (child > 0) return child;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (counted) {
    ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
    raise(SIGSTOP);
  }
  return 0;
}

void limit(decltype(RLIMIT_FSIZE) resource, long at) {
  const rlimit both{rlim_t(at), rlim_t(at)};
  setrlimit(resource, &both);
}

/// In the child.
void put_under(Fault fault) {
  signal(SIGXFSZ, SIG_IGN);  // as run_program() does
  if (fault.kind == Fault::Kind::file_size) limit(RLIMIT_FSIZE, fault.at);
  if (fault.kind == Fault::Kind::open_files) limit(RLIMIT_NOFILE, fault.at);
}

RunOutcome follow(pid_t child, Fault fault, bool counted) {
  RunOutcome outcome;
  const auto begin = Clock::now();
  if (counted)
    kill_by_call(child, fault.at, outcome);
  else
    kill_by_time(child, fault.kind == Fault::Kind::time ? fault.at : 600'000'000, outcome);
  outcome.duration_us = long(std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - begin).count());
  return outcome;
}

}  // namespace

RunOutcome run_under(Fault fault, const std::function<void(const Commit&)>& work) {
  const bool counted = fault.kind == Fault::Kind::call;
  int ends[2], words[2];
  if (pipe2(ends, O_CLOEXEC) != 0 || pipe2(words, O_CLOEXEC) != 0) fail("pipe");
  const pid_t child = start(counted);
  if (child == 0) {
    put_under(fault);
    int code = 0;
    std::string why;
    try {
      work([&](Promise promise) {
        if (write(ends[1], &promise, sizeof promise) != sizeof promise) _exit(4);
      });
    } catch (const InputError& error) {
      why = error.what();
      code = 2;
    } catch (const std::exception& error) {
      why = error.what();
      code = 1;
    }
    if (write(words[1], why.data(), std::min<std::size_t>(why.size(), 4000)) < 0) code = 4;
    _exit(code);
  }
  close(ends[1]);
  close(words[1]);
  RunOutcome outcome = follow(child, fault, counted);
  Promise promise;
  while (read(ends[0], &promise, sizeof promise) == sizeof promise) outcome.promises.push_back(promise);
  outcome.said = all_of(words[0]);
  close(ends[0]);
  close(words[0]);
  return outcome;
}

std::string run_in_child(const std::function<void()>& work) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail("pipe");
  const pid_t child = start(false);
  if (child == 0) {
    std::string why;
    try {
      work();
    } catch (const std::exception& error) {
      why = error.what();
      if (why.empty()) why = "something without a name";
    }
    why.resize(std::min<std::size_t>(why.size(), 4000));
    if (write(ends[1], why.data(), why.size()) != ssize_t(why.size())) _exit(4);
    _exit(why.empty() ? 0 : 1);
  }
  close(ends[1]);
  std::string why = all_of(ends[0]);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (why.empty() && status != 0) why = "the process that looked crashed";
  return why;
}

RunOutcome run_program_under(Fault fault, const std::vector<std::string>& command,
                             const std::filesystem::path& output) {
  const pid_t child = start(false);
  if (child == 0) {
    const int file = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    std::vector<char*> words;
    for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    execv(words[0], words.data());
    _exit(127);
  }
  return follow(child, fault, false);
}

bool can_count_calls() {
  try {
    return run_under({Fault::Kind::call, 0}, [](const Commit& commit) { commit({1, 1}); }).calls > 0;
  } catch (const std::runtime_error&) {
    return false;
  }
}

}  // namespace insonate
