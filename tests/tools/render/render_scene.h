#pragma once

#include <string>
#include <vector>

#include "tests/core/run_program.h"

namespace insonate::test {

/// A folder with the synthetic CT (ct.nrrd), a pose over it (pose.txt) and settings that draw fast (small.toml).
struct Scene {
  TemporaryFolder folder;
  Scene();
  std::string in(const char* name) const { return (folder.path / name).string(); }
  /// Runs insonate-render on the CT; it writes image.png.
  ProgramOutcome render(const std::string& more) const;
  /// Returns the names of the files in the folder, sorted.
  std::vector<std::string> names() const;
};

/// Returns the grey levels of a PNG, row by row.
std::vector<std::uint8_t> grey_levels(const std::filesystem::path& file);

}  // namespace insonate::test
