#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace insonate {

/// Returns the bytes of a whole file. Throws InputError if it is missing, a folder, unreadable, empty or larger than
/// `limit` bytes.
std::string read_file(const std::filesystem::path& file, std::size_t limit = 1u << 30);

/// Returns the size of a file in bytes. Throws InputError if it is missing, a folder, not a file on a disk, or empty.
std::uintmax_t check_is_file(const std::filesystem::path& file);

/// Returns a name beside `target` for a file or folder that is filled and then renamed to `target`:
/// `.STEM.ID.partial.EXTENSION`, where ID is 16 random hexadecimal digits, so that no two calls return the same name,
/// in threads, processes or on machines that share a disk. It keeps the extension, for writers that choose their format
/// by it.
std::filesystem::path temporary_beside(const std::filesystem::path& target);

/// Removes the temporary files or folders of `target` (temporary_beside) that are more than a day old. Killed programs
/// left them: a running program removes its own.
void remove_old_temporaries(const std::filesystem::path& target);

/// Calls `write` with a temporary name beside `file` and renames the result into place when `write` has returned.
/// Readers thus see the old file or the whole new one. Makes the parent folders, and removes old temporary files of
/// `file`. Removes the temporary file if `write` throws. Throws InputError if the folder cannot be made or the name
/// cannot be taken.
void write_atomically(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// Writes `bytes` to `file` in the same way. Throws InputError.
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// Writes `bytes` to a temporary file beside `file` and returns its path, for a caller that decides itself whether it
/// takes the name. Throws InputError, and then leaves no file.
std::filesystem::path write_beside(const std::filesystem::path& file, std::string_view bytes);

/// Returns STEM followed by `extension` if nothing has that name, else the first free one of STEM-2, STEM-3...
/// @param extension  ".png"; empty for a folder
std::filesystem::path free_path(const std::filesystem::path& stem, const std::string& extension);

/// Returns the folder of bundled assets: $INSONATE_ASSETS, or that of set_assets_folder(), or share/insonate beside the
/// folder that holds the program, in an install as in a build. Throws InputError if the latter does not exist.
std::filesystem::path assets_folder();

/// Sets what assets_folder() returns in a program that is not installed with the assets. Call it before threads do.
void set_assets_folder(const std::filesystem::path& folder);

/// Returns $XDG_CACHE_HOME/insonate, else $HOME/.cache/insonate, else a folder under the system's temporary folder.
std::filesystem::path cache_folder();

}  // namespace insonate
