#pragma once

#include <cstdint>
#include <filesystem>

#include "sim/core/image.h"

namespace insonate {

/// Reads a PNG of any kind as grey levels; colours become their luminance, and what is transparent becomes black.
/// Throws InputError if it cannot be read, or has more than 8192 pixels along a side.
Image<std::uint8_t> read_png(const std::filesystem::path& file);

}  // namespace insonate
