#pragma once

#include <filesystem>
#include <functional>

namespace insonate {

/// Throws InputError if a file or folder of that name exists.
void refuse_taken(const std::filesystem::path& folder);

/// Throws InputError if a folder of that name, or one beside it, could not be created now. What takes long asks first.
void refuse_unwritable(const std::filesystem::path& folder);

/// Calls `fill` with a temporary folder and then renames it, so that the folder appears completely or not at all. If
/// `fill` throws, nothing remains. Removes what killed programs left of it (remove_old_temporaries()). Throws
/// InputError if the folder cannot be created, or if its name is taken.
void write_folder(const std::filesystem::path& folder, const std::function<void(const std::filesystem::path&)>& fill);

}  // namespace insonate
