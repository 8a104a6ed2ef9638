#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "sim/core/image.h"

namespace insonate {

/// Writes a PNG under a temporary name and renames it. Throws InputError if it cannot be written.
void write_png(const std::filesystem::path& file, const Image<std::uint8_t>& grey);
void write_png(const std::filesystem::path& file, const Image<Rgba8>& image);

/// Returns a picture encoded as PNG, for storage elsewhere than in a file. Throws std::runtime_error if the encoding
/// fails.
std::string png_bytes(const Image<std::uint8_t>& grey);
std::string png_bytes(const Image<Rgba8>& image);

/// Reads a PNG of any kind as grey levels; colours become their luminance, and what is transparent becomes black.
/// Throws InputError if it cannot be read, or has more than 8192 pixels along a side.
Image<std::uint8_t> read_png(const std::filesystem::path& file);

}  // namespace insonate
