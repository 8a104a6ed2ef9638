#pragma once

#include <catch2/catch.hpp>
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <vector>

// Faults of the system that a test can cause in its own process. They also affect root, who ignores permissions.

namespace insonate {

/// While an object exists, this process can open no file, or only so many at the same time.
class NoFilesToOpen {
public:
  explicit NoFilesToOpen(std::size_t but = 0) {
    REQUIRE(getrlimit(RLIMIT_NOFILE, &before_) == 0);
    rlimit few = before_;
    few.rlim_cur = 0;
    std::vector<int> opened;
    while (opened.size() < but) opened.push_back(open("/dev/null", O_RDONLY | O_CLOEXEC));
    for (const int descriptor : opened) {
      few.rlim_cur = std::max(few.rlim_cur, rlim_t(descriptor) + 1);
      close(descriptor);
    }
    REQUIRE(setrlimit(RLIMIT_NOFILE, &few) == 0);
  }
  NoFilesToOpen(const NoFilesToOpen&) = delete;
  NoFilesToOpen& operator=(const NoFilesToOpen&) = delete;
  ~NoFilesToOpen() { setrlimit(RLIMIT_NOFILE, &before_); }

private:
  rlimit before_{};
};

/// A kernel file that claims 4096 bytes and ends after a few, like a file that shrinks while it is read. It cannot be
/// opened for writing.
inline const char* const kShorterThanItClaims = "/sys/devices/system/cpu/online";

/// A kernel file that claims 4096 bytes and can be opened, but fails to be read, as on a damaged disk.
inline const char* const kUnreadable = "/sys/class/net/lo/speed";

}  // namespace insonate
