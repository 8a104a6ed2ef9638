#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

#include "sim/core/files.h"

namespace insonate::test {

/// A folder for a study and its datasets, removed at its end.
struct StudyFolder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("insonate_dataset_test_" + std::to_string(getpid()));
  StudyFolder() { std::filesystem::create_directories(path); }
  ~StudyFolder() { std::filesystem::remove_all(path); }
  StudyFolder(const StudyFolder&) = delete;
  StudyFolder& operator=(const StudyFolder&) = delete;

  std::filesystem::path file(const std::string& name, const std::string& text) const {
    write_file(path / name, text);
    return path / name;
  }
};

}  // namespace insonate::test
