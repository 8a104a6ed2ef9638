#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace insonate {

/// The process that worked apart ended before its work did.
struct SubprocessDied : std::runtime_error {
  SubprocessDied() : std::runtime_error("the work ended its process") {}
};

/// Does `work` in a process of its own, forked from this one, and returns what it returns.
///
/// GDCM as Debian builds it checks damaged files by assertions, and an assertion ends the program; elsewhere it
/// believes a length that it reads and takes gigabytes. What a person hands over must not be able to do that, so DICOM
/// is read apart. The process prints nothing. It is ended when it takes more memory or processor time than `bytes` of
/// input can need: 64 times as much and 512 MiB, a second a MiB and 10 seconds; or when it waits for 2 minutes longer
/// than that. An InputError from `work` passes through; anything else that keeps it from returning is SubprocessDied.
std::string in_subprocess(std::uintmax_t bytes, const std::function<std::string()>& work);

}  // namespace insonate
