#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "sim/core/image.h"

namespace insonate {

/// Throws InputError when something of that name is there.
void refuse_taken(const std::filesystem::path& folder);

/// Lets `fill` write into a folder of a temporary name and renames it, so that the folder appears whole or not at all;
/// what `fill` throws leaves nothing behind. Throws InputError when the folder cannot be made, or its name is taken.
void write_folder(const std::filesystem::path& folder, const std::function<void(const std::filesystem::path&)>& fill);

/// Writes raw little-endian float32 as NRRD.
/// @param axes     NRRD's labels of them, in quotes, the fastest first
/// @param content  what the values are
void write_nrrd(const std::filesystem::path& file, const Image<float>& image, const char* axes,
                const std::string& content);

/// The same of values among the scan lines (x line, y sample), and of what is as the picture. `name` has no extension.
void write_among_lines(const std::filesystem::path& folder, const char* name, const Image<float>& image,
                       const std::string& content);
void write_as_picture(const std::filesystem::path& folder, const char* name, const Image<float>& image,
                      const std::string& content);

Image<float> in_single_precision(const Image<double>& image);
Image<float> in_single_precision(const Image<std::uint8_t>& image);

}  // namespace insonate
