#pragma once

#include <filesystem>
#include <memory>

namespace insonate {

// Files that are open and locked in this process, such as a database. POSIX gives up all locks that a process has on a
// file as soon as it closes the file, whatever opened it. So code that looks into files that it happens to find asks
// is_held() first, and does not open a file that is held.

/// Registers a file, and the -wal, -shm and -journal files beside it, as held until the result and its copies are gone.
/// Does nothing for a file that does not exist.
std::shared_ptr<const void> hold_file(const std::filesystem::path& file);

/// Returns whether a file is held, under any of its names. Threads may ask at once.
bool is_held(const std::filesystem::path& file);

}  // namespace insonate
