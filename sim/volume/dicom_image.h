#pragma once

#include <glm/vec2.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace insonate {

/// The decoded image of one DICOM file.
struct DicomImage {
  std::string type;            ///< of the values after the rescale: "int16"
  std::vector<double> values;  ///< row by row, after the rescale slope and intercept
};

/// Decodes the image of a DICOM file. Call it in a subprocess (subprocess.h), because a damaged file can end the
/// process and claim more memory than there is. Throws InputError if the file cannot be decoded, or is not one grey
/// image of `size` columns and rows. A size of zero means any.
DicomImage read_dicom_image(const std::filesystem::path& file, const glm::uvec2& size = glm::uvec2(0));

/// Throws InputError if a file ends before its uncompressed pixels do. GDCM invents what they lack.
/// @param needed  bytes of all pixels
void check_raw_pixels(const std::filesystem::path& file, std::uint64_t needed, bool is_big_endian);

}  // namespace insonate
