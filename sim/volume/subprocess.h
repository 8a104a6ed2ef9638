#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace insonate {

/// Thrown if the subprocess ends before its work is complete.
struct SubprocessDied : std::runtime_error {
  SubprocessDied() : std::runtime_error("the work ended its process") {}
};

/// Runs `work` in a subprocess, forked from this process, and returns its result.
///
/// Debian's build of GDCM checks damaged files by assertions, and a failed assertion ends the program. Elsewhere GDCM
/// trusts a length that it reads and allocates gigabytes. A user's file must not be able to do that, so DICOM is read
/// in a subprocess. The subprocess prints nothing. It is killed if it takes more memory or processor time than `bytes`
/// of input can need: 64 times as much plus 512 MiB, and 1 s per MiB plus 10 s. It is also killed if it takes more than
/// 120 s plus 1 s per MiB of wall time. An InputError from `work` is rethrown; any other failure to return throws
/// SubprocessDied.
std::string in_subprocess(std::uintmax_t bytes, const std::function<std::string()>& work);

}  // namespace insonate
