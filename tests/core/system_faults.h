#pragma once

#include <catch2/catch.hpp>
#include <sys/resource.h>

// Faults of the system that a test can bring about in its own process, also as root, whom permissions do not stop.

namespace insonate {

/// While it lives, this process can open no file.
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

/// A file of the kernel's that claims 4096 bytes and ends after a few, as a file does that shrinks while it is read.
/// Nobody can open it for writing.
inline const char* const kShorterThanItClaims = "/sys/devices/system/cpu/online";

/// A file of the kernel's that claims 4096 bytes and can be opened; to read it is an error, as on a damaged disk.
inline const char* const kUnreadable = "/sys/class/net/lo/speed";

}  // namespace insonate
