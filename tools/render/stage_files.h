#pragma once

#include <filesystem>
#include <string>

#include "sim/core/image.h"

namespace insonate {

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

/// Return the image as floats, rounded.
Image<float> in_single_precision(const Image<double>& image);
Image<float> in_single_precision(const Image<std::uint8_t>& image);

}  // namespace insonate
