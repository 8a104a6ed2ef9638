#pragma once

#include <filesystem>
#include <future>

namespace insonate::ui {

/// Opens a file or folder with the desktop's default program, without waiting for it. Within some 2 s, the result says
/// whether there is such a program.
std::future<bool> open_on_desktop(const std::filesystem::path& file);

}  // namespace insonate::ui
