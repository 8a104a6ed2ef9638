#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace insonate {

/// A new file with one writer that only appends. is_being_written() detects a file that is still open. Once append()
/// has returned, the operating system holds the bytes, so they survive if the program is killed. If append() throws,
/// the file is as it was, so the caller can try again.
class AppendOnlyFile {
public:
  /// Throws InputError if the file already exists or cannot be created. Creates the parent folders.
  /// @param when_full  remedy for the error message when append() cannot write
  explicit AppendOnlyFile(std::filesystem::path file, std::string when_full = "make room on the disk and record again");
  ~AppendOnlyFile();
  AppendOnlyFile(const AppendOnlyFile&) = delete;
  AppendOnlyFile& operator=(const AppendOnlyFile&) = delete;

  /// Throws InputError if not all bytes can be written.
  void append(std::string_view bytes);

  std::uint64_t size() const { return size_; }
  const std::filesystem::path& path() const { return file_; }

private:
  std::filesystem::path file_;
  std::string when_full_;
  int descriptor_;
  std::uint64_t size_ = 0;
};

/// Returns whether an AppendOnlyFile of this or another program has the file open.
bool is_being_written(const std::filesystem::path& file);

}  // namespace insonate
