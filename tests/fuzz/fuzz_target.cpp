#include "tests/fuzz/fuzz_target.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sim/core/input_error.h"

namespace insonate::fuzz {
namespace {

namespace fs = std::filesystem;

std::vector<const Target*>& all() {
  static std::vector<const Target*> targets;
  return targets;
}

/// What is wrong with a text that people are to read: a sentence, or a line that announces several and one line each.
/// Empty when nothing is.
std::string why_unfit(std::string_view text) {
  constexpr std::size_t kLongestLine = 5000;
  if (text.empty() || (text.back() != '.' && text.back() != '?')) return "a refusal is not a sentence";
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (line.empty() || line.size() > kLongestLine) return "a line of a refusal is empty or too long to read";
    if (std::any_of(line.begin(), line.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }))
      return "a refusal holds control characters";
  }
  return "";
}

struct Folder {
  fs::path path = fs::temp_directory_path() / ("insonate-fuzz-" + std::to_string(getpid()));
  Folder() { fs::create_directories(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

}  // namespace

Target::Target(std::string called, Promises kept) : name(std::move(called)), promises(std::move(kept)) {
  all().push_back(this);
}

const std::vector<const Target*>& targets() {
  return all();
}

std::string broken_by(const std::function<std::string()>& use) {
  try {
    return use();
  } catch (const InputError& error) {
    const std::string why = why_unfit(error.what());
    return why.empty() ? "" : why + ": " + error.what();
  }
}

fs::path file_with(const std::string& name, std::string_view bytes) {
  static const Folder folder;
  const fs::path file = folder.path / name;
  if (file.has_parent_path()) fs::create_directories(file.parent_path());
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const bool whole = descriptor >= 0 && write(descriptor, bytes.data(), bytes.size()) == ssize_t(bytes.size());
  if (descriptor >= 0) close(descriptor);
  if (!whole) throw std::runtime_error("the fuzz target cannot write " + file.string());
  return file;
}

}  // namespace insonate::fuzz
