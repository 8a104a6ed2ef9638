#pragma once

#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "sim/files/files.h"
#include "sim/phantom/phantom.h"
#include "sim/volume/open_case.h"

namespace insonate {

/// Shows the progress of the phantom builder on standard error if that is a terminal.
inline void show_progress(double share) {
  if (isatty(STDERR_FILENO))
    std::fprintf(stderr, "\rmaking the phantom: %3.0f %%%s", 100 * share, share >= 1 ? "\n" : "");
}

/// Opens the named patient: a case folder, CT file or DICOM folder. Opens the built-in abdomen if nothing is named.
inline Case open_subject(const std::filesystem::path& named) {
  if (!named.empty()) return open_case(named);
  return cached_phantom(assets_folder() / "phantoms" / "abdomen.toml", {}, cache_folder(), show_progress);
}

}  // namespace insonate
