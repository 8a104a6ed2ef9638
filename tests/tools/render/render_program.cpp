#include "tests/tools/render/render_program.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace insonate::test {

TestFolder::TestFolder()
    : path(std::filesystem::temp_directory_path() / ("insonate_render_test_" + std::to_string(getpid()))) {
  std::filesystem::create_directories(path);
}

TestFolder::~TestFolder() {
  std::filesystem::remove_all(path);
}

std::filesystem::path TestFolder::file(const std::string& name, const std::string& text) const {
  std::ofstream(path / name, std::ios::binary) << text;
  return path / name;
}

Outcome run(const TestFolder& folder, const std::string& program, const std::string& arguments) {
  const auto errors = folder.path / "errors";
  const int status = std::system((program + " " + arguments + " 2>" + errors.string()).c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes_of(errors)};
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace insonate::test
