#include "sim/files/new_folder.h"

#include <system_error>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/files/files.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

fs::path without_slash(const fs::path& folder) {
  return folder.has_filename() ? folder : folder.parent_path();
}

/// Returns the missing parent folders of a folder, the outermost last.
std::vector<fs::path> missing_above(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code error;
  for (fs::path above = folder.parent_path(); !above.empty() && !fs::exists(above, error);) {
    missing.push_back(above);
    above = above.parent_path();
  }
  return missing;
}

[[noreturn]] void refuse(const fs::path& folder, const std::error_code& error) {
  throw InputError(folder.string(), "", "the folder cannot be written (" + error.message() + ")",
                   "name a folder that may be written");
}

}  // namespace

void refuse_taken(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(fs::symlink_status(without_slash(folder), error)))
    throw InputError(folder.string(), "", "something of this name is there", "name a folder that is new");
}

void refuse_unwritable(const fs::path& folder) {
  const fs::path target = without_slash(folder), temporary = temporary_beside(target);
  const std::vector<fs::path> made = missing_above(target);
  std::error_code error, ignored;
  fs::create_directories(temporary, error);
  fs::remove(temporary, ignored);
  for (const fs::path& above : made) fs::remove(above, ignored);
  if (error) refuse(folder, error);
}

void write_folder(const fs::path& folder, const std::function<void(const fs::path&)>& fill) {
  const fs::path target = without_slash(folder);
  const fs::path temporary = temporary_beside(target);
  remove_old_temporaries(target);
  const std::vector<fs::path> made = missing_above(target);
  const auto clean_up = [&] {
    std::error_code ignored;
    fs::remove_all(temporary, ignored);
    for (const fs::path& above : made) fs::remove(above, ignored);
  };
  std::error_code error;
  fs::create_directories(temporary, error);
  if (!error) {
    try {
      fill(temporary);
      refuse_taken(target);
    } catch (...) {
      clean_up();
      throw;
    }
    fs::rename(temporary, target, error);
  }
  if (error) {
    clean_up();
    refuse(folder, error);
  }
}

}  // namespace insonate
