#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "sim/core/image.h"

namespace insonate {

/// Throws InputError if a file or folder of that name exists.
void refuse_taken(const std::filesystem::path& folder);

/// Calls `fill` with a temporary folder and then renames it, so that the folder appears completely or not at all. If
/// `fill` throws, nothing remains. Throws InputError if the folder cannot be created, or if its name is taken.
void write_folder(const std::filesystem::path& folder, const std::function<void(const std::filesystem::path&)>& fill);

/// Writes raw little-endian float32 as NRRD.
/// @param axes     NRRD labels of the axes, in quotes, the fastest first
/// @param content  description of the values
void write_nrrd(const std::filesystem::path& file, const Image<float>& image, const char* axes,
                const std::string& content);

/// Write an image sampled along the scan lines (x line, y sample), or one with the picture's pixels. `name` has no
/// extension.
void write_among_lines(const std::filesystem::path& folder, const char* name, const Image<float>& image,
                       const std::string& content);
void write_as_picture(const std::filesystem::path& folder, const char* name, const Image<float>& image,
                      const std::string& content);

Image<float> in_single_precision(const Image<double>& image);
Image<float> in_single_precision(const Image<std::uint8_t>& image);

}  // namespace insonate
