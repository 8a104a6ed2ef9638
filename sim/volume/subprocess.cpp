#include "sim/volume/subprocess.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>

#include "sim/core/input_error.h"

namespace insonate {
namespace {

// The first byte through the pipe. It states what the rest is.
constexpr char kResult = 'R', kInputError = 'E';

// Returns how much address space this process already uses.
rlim_t taken_bytes() {
  unsigned long pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return rlim_t(pages) * rlim_t(sysconf(_SC_PAGESIZE));
}

void limit(decltype(RLIMIT_AS) resource, rlim_t value) {
  const rlimit both{value, value};
  setrlimit(resource, &both);
}

bool send(int pipe_end, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t sent = write(pipe_end, data, size);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    data += sent;
    size -= std::size_t(sent);
  }
  return true;
}

std::string receive_all(int pipe_end) {
  std::string received;
  char buffer[1 << 16];
  for (;;) {
    const ssize_t count = read(pipe_end, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return received;
    received.append(buffer, std::size_t(count));
  }
}

[[noreturn]] void work_and_send(int pipe_end, std::uintmax_t bytes, const std::function<std::string()>& work) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // the parent, which waits for the result, may end
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_AS, taken_bytes() + (rlim_t(512) << 20) + 64 * rlim_t(bytes));
  limit(RLIMIT_CPU, 10 + rlim_t(bytes >> 20));
  alarm(unsigned(120 + (bytes >> 20)));
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  // The handlers of a test runner or sanitizer would report the death as the parent's.
  for (int death : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) signal(death, SIG_DFL);
  char kind = kResult;
  std::string answer;
  try {
    answer = work();
  } catch (const InputError& error) {
    kind = kInputError;
    answer = error.what();
  } catch (...) {
    _exit(EXIT_FAILURE);
  }
  _exit(send(pipe_end, &kind, 1) && send(pipe_end, answer.data(), answer.size()) ? EXIT_SUCCESS : EXIT_FAILURE);
}

}  // namespace

std::string in_subprocess(std::uintmax_t bytes, const std::function<std::string()>& work) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe to be had");
  const pid_t child = fork();
  if (child < 0) {
    close(ends[0]);
    close(ends[1]);
    throw std::runtime_error("no second process to be had");
  }
  if (child == 0) work_and_send(ends[1], bytes, work);
  close(ends[1]);
  std::string received = receive_all(ends[0]);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != EXIT_SUCCESS || received.empty()) throw SubprocessDied();
  const char kind = received.front();
  received.erase(0, 1);
  if (kind == kInputError) throw InputError(received);
  return received;
}

}  // namespace insonate
