#pragma once

#include <filesystem>

namespace insonate::ui {

/// Opens a file or folder with the desktop's default program, without waiting for it. Writes a line to stderr if
/// the desktop cannot be asked.
void open_on_desktop(const std::filesystem::path& file);

}  // namespace insonate::ui
