#pragma once

#include <filesystem>
#include <string>

namespace insonate::test {

/// A folder for the files of one test, removed at its end.
struct TestFolder {
  std::filesystem::path path;
  TestFolder();
  ~TestFolder();
  std::filesystem::path file(const std::string& name, const std::string& text) const;
};

struct Outcome {
  int code;
  std::string errors;  ///< its output on standard error
};
/// Runs a program. The shell splits its arguments.
Outcome run(const TestFolder& folder, const std::string& program, const std::string& arguments);

std::string bytes_of(const std::filesystem::path& file);

}  // namespace insonate::test
