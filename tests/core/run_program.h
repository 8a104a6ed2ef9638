#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "sim/files/files.h"
#include "tests/core/temporary_folder.h"

namespace insonate {

struct ProgramOutcome {
  int code;  ///< its exit code; -1 if a signal ended it
  std::string output, errors;
};

/// Runs a command line by the shell, and returns what it printed.
inline ProgramOutcome run_program(const std::string& command) {
  const TemporaryFolder folder;
  const std::filesystem::path output = folder.path / "output", errors = folder.path / "errors";
  const int status = std::system(("{ " + command + "\n} >" + output.string() + " 2>" + errors.string()).c_str());
  const auto text_of = [](const std::filesystem::path& file) {
    return std::filesystem::file_size(file) > 0 ? read_file(file) : "";
  };
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(output), text_of(errors)};
}

inline bool contains(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

}  // namespace insonate
