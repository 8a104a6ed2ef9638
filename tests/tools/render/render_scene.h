#pragma once

#include <string>
#include <vector>

#include "tests/tools/render/render_program.h"

namespace outsider {

/// A folder with the synthetic CT (ct.nrrd), a pose over it (pose.txt) and settings that draw fast (small.toml).
struct Scene {
  TestFolder folder;
  Scene();
  std::string in(const char* name) const { return (folder.path / name).string(); }
  /// Runs insonate-render on the CT, with image.png to be written.
  Outcome render(const std::string& more) const;
  /// What lies in the folder, sorted.
  std::vector<std::string> names() const;
};

/// Of a PNG, row by row.
std::vector<double> grey_levels(const std::filesystem::path& file);

}  // namespace outsider
