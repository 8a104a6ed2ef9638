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

/// Lets `write` fill a temporary name beside `file` and renames it into place when `write` returned, so that whoever
/// looks sees the old file or the whole new one. Makes the parent folders. The temporary name keeps the extension, for
/// writers that choose their format by it, and is removed when `write` throws. Throws InputError when the folder can't
/// be made or the name not be taken.
void write_atomically(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same for bytes at hand.
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// The folder of bundled assets: $INSONATE_ASSETS, or share/insonate beside the program's bin folder, or the source
/// tree the program was built in. Throws InputError when none of them is there.
std::filesystem::path assets_folder();

/// $XDG_CACHE_HOME/insonate, else $HOME/.cache/insonate, else a folder under the system's temporary folder.
std::filesystem::path cache_folder();

}  // namespace insonate
