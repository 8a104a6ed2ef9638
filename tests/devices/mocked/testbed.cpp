#include "testbed.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <umockdev.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <thread>

namespace insonate {
namespace {

// The preloaded library comes before AddressSanitizer's, where there is one.
std::vector<std::string> settings() {
  const char* asan = std::getenv("ASAN_OPTIONS");
  return {"LD_PRELOAD=libumockdev-preload.so.0",
          "ASAN_OPTIONS=" + (asan ? std::string(asan) + ":" : "") + "verify_asan_link_order=0:detect_leaks=0"};
}

}  // namespace

Testbed::Testbed() : testbed_(umockdev_testbed_new()) {
  gchar* root = umockdev_testbed_get_root_dir(testbed_);
  root_ = root;
  g_free(root);
  // hidapi and libusb look into these before anything is plugged in.
  for (const char* folder : {"/dev", "/dev/bus", "/dev/bus/usb", "/dev/bus/usb/001", "/sys/class", "/sys/class/hidraw",
                             "/sys/bus", "/sys/bus/usb", "/sys/bus/usb/devices"})
    mkdir(real_path(folder).c_str(), 0755);
}

Testbed::~Testbed() {
  g_object_unref(testbed_);
}

std::string Testbed::why_not() {
  Testbed testbed;
  gchar* path =
      umockdev_testbed_add_device(testbed.get(), "misc", "greeter", nullptr, "greeting", "welcome", nullptr, nullptr);
  Child cat({"/bin/cat", std::string(path) + "/greeting"});
  g_free(path);
  const bool ended = pump([&] {
    cat.listen();
    return cat.ended();
  });
  cat.listen();
  if (ended && cat.out == "welcome") return "";
  return "a program in umockdev's test bed does not see its devices: " + (cat.err.empty() ? cat.out : cat.err);
}

Node::Node(const std::string& path, bool packets) : path_(path) {
  if (mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error("no pipe can be made at " + path);
  fd_ = open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (packets) fcntl(fd_, F_SETFL, O_NONBLOCK | O_DIRECT);
  if (!packets) fcntl(fd_, F_SETPIPE_SZ, 4096);
}

Node::~Node() {
  close(fd_);
  unlink(path_.c_str());
}

bool Node::write(const std::vector<unsigned char>& bytes) {
  return ::write(fd_, bytes.data(), bytes.size()) == ssize_t(bytes.size());
}

void Node::make_writable(bool writable) {
  std::array<unsigned char, 4096> page{};
  if (writable)
    while (::read(fd_, page.data(), page.size()) > 0) continue;
  else
    while (::write(fd_, page.data(), page.size()) > 0) continue;
}

void Node::allow(bool allowed) {
  chmod(path_.c_str(), allowed ? 0600 : 0);
}

bool Node::is_open_elsewhere() const {
  namespace fs = std::filesystem;
  struct stat mine {};
  fstat(fd_, &mine);
  for (const fs::directory_entry& process : fs::directory_iterator("/proc")) {
    const std::string pid = process.path().filename().string();
    if (pid.find_first_not_of("0123456789") != std::string::npos || pid == std::to_string(getpid())) continue;
    std::error_code error;  // a process may end meanwhile
    fs::directory_iterator file(process.path() / "fd", error);
    for (; !error && file != fs::directory_iterator(); file.increment(error)) {
      struct stat theirs {};
      if (stat(file->path().c_str(), &theirs) == 0 && theirs.st_dev == mine.st_dev && theirs.st_ino == mine.st_ino)
        return true;
    }
  }
  return false;
}

Child::Child(const std::vector<std::string>& command) : ChildProcess(command, settings()) {}

bool pump(const std::function<bool()>& done, const std::function<void()>& each_time) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(3);
  while (std::chrono::steady_clock::now() < limit) {
    each_time();
    bool worked = false;
    while (g_main_context_iteration(nullptr, FALSE)) worked = true;
    if (done()) return true;
    if (!worked) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

}  // namespace insonate
