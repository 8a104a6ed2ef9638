#pragma once

#include <filesystem>
#include <string>

#include "sim/files/files.h"
#include "tests/core/temporary_folder.h"

namespace insonate::test {

/// A folder for a study and its datasets, removed at its end.
struct StudyFolder {
  TemporaryFolder folder;
  std::filesystem::path path = folder.path;

  std::filesystem::path file(const std::string& name, const std::string& text) const {
    write_file(path / name, text);
    return path / name;
  }
};

}  // namespace insonate::test
