#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace insonate {

/// A whole file as bytes. Throws InputError when it is missing, a folder, unreadable, empty or above `limit` bytes.
std::string read_file(const std::filesystem::path& file, std::size_t limit = 1u << 30);

/// Throws InputError when a file is missing, a folder, no file on a disk, or empty; returns how many bytes it has.
std::uintmax_t check_is_file(const std::filesystem::path& file);

/// The name beside `target` that this process fills before it renames it: `.STEM.PID.partial.EXTENSION`. It keeps the
/// extension, for writers that choose their format by it.
std::filesystem::path temporary_beside(const std::filesystem::path& target);

/// Removes the temporary files or folders of `target` (temporary_beside) that are more than a day old. Killed programs
/// left them: a program that runs removes its own.
void remove_old_temporaries(const std::filesystem::path& target);

/// Lets `write` fill a temporary name beside `file` and renames it into place when `write` returned, so that whoever
/// looks sees the old file or the whole new one. Makes the parent folders, and removes old temporaries of `file`. The
/// temporary file is removed when `write` throws. Throws InputError when the folder can't be made or the name not be
/// taken.
void write_atomically(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same for bytes at hand.
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// The folder of bundled assets: $INSONATE_ASSETS, or share/insonate beside the folder that holds the program. An
/// install has it there, and so has a build. Throws InputError when it is not there.
std::filesystem::path assets_folder();

/// $XDG_CACHE_HOME/insonate, else $HOME/.cache/insonate, else a folder under the system's temporary folder.
std::filesystem::path cache_folder();

}  // namespace insonate
