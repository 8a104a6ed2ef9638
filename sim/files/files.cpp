#include "sim/files/files.h"

#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cinttypes>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>

#include "sim/core/input_error.h"
#include "sim/core/text.h"

namespace insonate {

namespace fs = std::filesystem;

namespace {

/// Returns the text of the last system error in parentheses; empty if there is none.
std::string reason() {
  return errno == 0 ? "" : std::string(" (") + std::strerror(errno) + ")";
}

fs::path& chosen_assets() {
  static fs::path folder;
  return folder;
}

/// The parts of a temporary name before and after its random digits.
struct TemporaryName {
  std::string front, back;
  explicit TemporaryName(const fs::path& target)
      : front("." + target.stem().string() + "."), back(".partial" + target.extension().string()) {}

  bool matches(const std::string& name) const {
    if (name.size() <= front.size() + back.size() || !name.starts_with(front) || !name.ends_with(back)) return false;
    const std::string id = name.substr(front.size(), name.size() - front.size() - back.size());
    return id.find_first_not_of("0123456789abcdef") == std::string::npos;
  }
};

/// Throws InputError, which names `target`.
void write_bytes(const fs::path& temporary, std::string_view bytes, const fs::path& target) {
  errno = 0;
  std::ofstream stream(temporary, std::ios::binary);
  stream.write(bytes.data(), std::streamsize(bytes.size()));
  stream.close();
  if (!stream)
    throw InputError(target.string(), "", "it cannot be written" + reason(),
                     "check the folder's permissions and free space");
}

}  // namespace

std::uintmax_t check_is_file(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) throw InputError(file.string(), "", "there is no such file", "check the name");
  if (fs::is_directory(status)) throw InputError(file.string(), "", "this is a folder", "name a file in it");
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) throw InputError(file.string(), "", "it is not an ordinary file", "name a file on disk");
  if (size == 0) throw InputError(file.string(), "", "the file is empty", "write or copy it again");
  return size;
}

std::string read_file(const fs::path& file, std::size_t limit) {
  const std::uintmax_t size = check_is_file(file);
  if (size > limit)
    throw InputError(file.string(), "",
                     "the file has " + std::to_string(size) + " bytes, above the limit of " + std::to_string(limit),
                     "check that it is the right file");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(size, '\0');
  if (!stream.read(bytes.data(), std::streamsize(size)))
    throw InputError(file.string(), "", "it cannot be read" + reason(), "check its permissions");
  return bytes;
}

fs::path temporary_beside(const fs::path& target) {
  const TemporaryName name(target);
  std::uint64_t number = 0;
  if (getentropy(&number, sizeof number) != 0) throw std::system_error(errno, std::generic_category(), "getentropy");
  fs::path temporary = target;
  return temporary.replace_filename(name.front + formatted("%016" PRIx64, number) + name.back);
}

void remove_old_temporaries(const fs::path& target) {
  const TemporaryName name(target);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  const fs::file_time_type day_before = fs::file_time_type::clock::now() - std::chrono::hours(24);
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code unknown;
    if (!name.matches(entry->path().filename().string())) continue;
    const fs::file_time_type written = fs::last_write_time(entry->path(), unknown);
    if (!unknown && written < day_before) fs::remove_all(entry->path(), unknown);
  }
}

void write_atomically(const fs::path& file, const std::function<void(const fs::path&)>& write) {
  std::error_code error;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
  if (error)
    throw InputError(file.parent_path().string(), "", "the folder cannot be made (" + error.message() + ")",
                     "name a folder that may be written");
  remove_old_temporaries(file);
  const fs::path temporary = temporary_beside(file);
  try {
    write(temporary);
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
  fs::rename(temporary, file, error);
  if (error) {
    const std::string why = error.message();
    fs::remove(temporary, error);
    throw InputError(file.string(), "", "it cannot be written (" + why + ")", "name a file that may be written");
  }
}

void write_file(const fs::path& file, std::string_view bytes) {
  write_atomically(file, [&](const fs::path& temporary) { write_bytes(temporary, bytes, file); });
}

fs::path write_beside(const fs::path& file, std::string_view bytes) {
  fs::path temporary = temporary_beside(file);
  try {
    write_bytes(temporary, bytes, file);
  } catch (...) {
    std::error_code error;
    fs::remove(temporary, error);
    throw;
  }
  return temporary;
}

fs::path free_path(const fs::path& stem, const std::string& extension) {
  fs::path free = stem.string() + extension;
  std::error_code error;  // writing there reports what is wrong
  for (int i = 2; fs::exists(free, error); ++i) free = stem.string() + "-" + std::to_string(i) + extension;
  return free;
}

fs::path assets_folder() {
  std::error_code error;
  if (const char* named = std::getenv("INSONATE_ASSETS")) return named;
  if (!chosen_assets().empty()) return chosen_assets();
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path folder = program.parent_path() / INSONATE_ASSETS_FROM_PROGRAM;
  if (fs::is_directory(folder, error)) return fs::weakly_canonical(folder, error);
  throw InputError(folder.lexically_normal().string(), "", "the bundled assets are not there",
                   "install Insonate again, or set INSONATE_ASSETS to their folder");
}

void set_assets_folder(const fs::path& folder) {
  chosen_assets() = folder;
}

fs::path cache_folder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) return fs::path(cache) / "insonate";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "insonate";
  return fs::temp_directory_path() / "insonate";
}

}  // namespace insonate
