#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace insonate {

/// A file that is made new and only ever appended to, by one: others can tell while it is (is_being_written). What
/// append() has returned from is the operating system's: the program may be killed then. An append() that throws leaves
/// the file as it was, so that it can be tried again.
class AppendOnlyFile {
public:
  /// Throws InputError when the file is there already or cannot be made. Makes the parent folders.
  /// @param when_full  what to do when append() cannot write
  explicit AppendOnlyFile(std::filesystem::path file, std::string when_full = "make room on the disk and record again");
  ~AppendOnlyFile();
  AppendOnlyFile(const AppendOnlyFile&) = delete;
  AppendOnlyFile& operator=(const AppendOnlyFile&) = delete;

  /// Throws InputError when not all of it can be written.
  void append(std::string_view bytes);

  std::uint64_t size() const { return size_; }
  const std::filesystem::path& path() const { return file_; }

private:
  std::filesystem::path file_;
  std::string when_full_;
  int descriptor_;
  std::uint64_t size_ = 0;
};

/// Whether an AppendOnlyFile has it open, of this program or another.
bool is_being_written(const std::filesystem::path& file);

}  // namespace insonate
