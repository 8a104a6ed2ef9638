#include "sim/files/held_files.h"

#include <sys/stat.h>

#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace insonate {
namespace {

using FileId = std::pair<dev_t, ino_t>;

std::mutex held_mutex;
std::multiset<FileId> held;

std::optional<FileId> id_of(const std::string& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) return std::nullopt;
  return FileId(status.st_dev, status.st_ino);
}

}  // namespace

std::shared_ptr<const void> hold_file(const std::filesystem::path& file) {
  const std::optional<FileId> id = id_of(file.string());
  if (!id) return nullptr;
  {
    const std::lock_guard lock(held_mutex);
    held.insert(*id);
  }
  return {nullptr, [id = *id](const void*) {
            const std::lock_guard lock(held_mutex);
            held.erase(held.find(id));
          }};
}

bool is_held(const std::filesystem::path& file) {
  std::string name = file.string();
  for (const std::string ending : {"-wal", "-shm", "-journal"})
    if (name.ends_with(ending)) name.resize(name.size() - ending.size());
  const std::optional<FileId> id = id_of(name);
  const std::lock_guard lock(held_mutex);
  return id && held.contains(*id);
}

}  // namespace insonate
