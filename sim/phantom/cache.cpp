#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <system_error>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/phantom/phantom.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

// Raise it when the same recipe would give other voxels, or when the layout of the files changes.
constexpr const char* kMakerVersion = "phantom maker 2";
constexpr const char* kDigestsFile = "digests.txt";

// 128 bits protect against damage and mix-ups, not against an attacker, who can write the digests as well as the cache.
std::string digest(const std::string& bytes) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(bytes.data(), bytes.size()));
  std::string text;
  for (const unsigned char byte : canonical.digest) {
    char hex[3];
    std::snprintf(hex, sizeof hex, "%02x", byte);
    text += hex;
  }
  return text;
}

std::string key_of(const std::string& recipe_text, const std::vector<std::pair<std::string, std::string>>& options) {
  // Lengths precede the parts, so that no two lists of parts give the same text.
  std::string all;
  const auto add = [&](const std::string& part) { all += std::to_string(part.size()) + ":" + part; };
  add(kMakerVersion);
  add(recipe_text);
  for (const auto& [option, value] : options) {
    add(option);
    add(value);
  }
  return digest(all);
}

// One line per file: its digest and its name.
std::string digests_of(const fs::path& folder) {
  std::map<std::string, std::string> digests;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name != kDigestsFile && name.front() != '.')
      digests[name] = digest(read_file(entry.path(), std::size_t(1) << 34));
  }
  std::string text;
  for (const auto& [name, value] : digests) text.append(value).append("  ").append(name).append("\n");
  return text;
}

// The digests are written last, so a folder without them is unfinished.
bool is_whole(const fs::path& folder) {
  try {
    return fs::is_directory(folder) && read_file(folder / kDigestsFile) == digests_of(folder);
  } catch (const InputError&) {
    return false;
  } catch (const fs::filesystem_error&) {
    return false;
  }
}

// Locks a cached folder: shared while it is read, alone to remove it. The lock ends with the process, so none is ever
// left behind. On a file system without such locks nothing is locked, and a reader whose files are removed makes the
// phantom again.
class FolderLock {
public:
  enum class Kind { shared, alone };

  FolderLock(const fs::path& folder, Kind kind) : file_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    held_ = file_ >= 0 && flock(file_, (kind == Kind::alone ? LOCK_EX : LOCK_SH) | LOCK_NB) == 0;
  }
  ~FolderLock() {
    if (file_ >= 0) close(file_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  bool held() const { return held_; }

private:
  int file_;
  bool held_ = false;
};

// Removes a folder: its name disappears at once, its files after that.
void throw_away(const fs::path& folder) {
  const FolderLock lock(folder, FolderLock::Kind::alone);
  if (!lock.held()) return;
  const fs::path gone = temporary_beside(folder);
  std::error_code error;
  fs::rename(folder, gone, error);
  if (!error) fs::remove_all(gone, error);
}

// A folder's modification time records its last use, by the file system's clock.
void mark_used(const fs::path& folder) {
  utimensat(AT_FDCWD, folder.c_str(), nullptr, 0);
}

// Keeps the `kept` most recently used phantoms, including `newest`. A process that ended too early leaves half-written
// or half-removed folders under names with a leading dot. They are removed when they are a day older than `newest`.
void tidy(const fs::path& newest, std::size_t kept) {
  std::error_code error;
  const fs::file_time_type day_before = fs::last_write_time(newest, error) - std::chrono::hours(24);
  std::vector<std::pair<fs::file_time_type, fs::path>> found;
  for (fs::directory_iterator entry(newest.parent_path(), error), end; !error && entry != end; entry.increment(error)) {
    std::error_code unknown;
    const fs::file_time_type used = fs::last_write_time(entry->path(), unknown);
    if (unknown || !entry->is_directory(unknown)) continue;
    if (entry->path().filename().string().front() != '.')
      found.emplace_back(used, entry->path());
    else if (used < day_before)
      fs::remove_all(entry->path(), unknown);
  }
  std::sort(found.begin(), found.end(), std::greater<>());
  for (std::size_t n = kept; n < found.size(); ++n) throw_away(found[n].second);
}

}  // namespace

Case cached_phantom(const fs::path& recipe, const std::vector<std::pair<std::string, std::string>>& options,
                    const fs::path& cache, const Progress& progress, std::size_t kept) {
  const std::string text = read_file(recipe, std::size_t(16) << 20);
  const fs::path folder = cache / "phantoms" / (recipe.stem().string() + "-" + key_of(text, options));
  {
    const FolderLock lock(folder, FolderLock::Kind::shared);
    if (is_whole(folder)) {
      try {
        Case subject = read_case(folder);
        mark_used(folder);
        return subject;
      } catch (const InputError&) {
        // Complete but unreadable: written by another version of the reader, or removed meanwhile. Make it again.
      }
    }
  }
  Case subject = make_phantom(recipe.string(), text, options, progress);
  try {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    write_case(folder, subject);
    write_file(folder / kDigestsFile, digests_of(folder));
    tidy(folder, kept);
  } catch (const InputError&) {
    // The case is complete all the same. A cache that cannot be written costs only the time to make it again.
  } catch (const fs::filesystem_error&) {
    // As above: another process removes the folder while its digests are computed.
  }
  return subject;
}

}  // namespace insonate
