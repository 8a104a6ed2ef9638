#pragma once

#include <catch2/catch.hpp>
#include <sys/resource.h>

// Faults of the system that a test can cause in its own process. They also affect root, who ignores permissions.

namespace insonate {

/// While an object exists, this process can open no file.
class NoFilesToOpen {
public:
  NoFilesToOpen() {
    REQUIRE(getrlimit(RLIMIT_NOFILE, &before_) == 0);
    rlimit none = before_;
    none.rlim_cur = 0;
    REQUIRE(setrlimit(RLIMIT_NOFILE, &none) == 0);
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
