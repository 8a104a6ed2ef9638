#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "sim/core/image.h"

namespace insonate {

/// The part of an ultrasound image that shows tissue in 2D, and the size of its pixels (DICOM PS3.3, C.8.5.5, US Region
/// Calibration).
struct UltrasoundRegion {
  std::array<int, 4> rectangle{};  ///< x, y, width, height, pixels, within the image
  glm::dvec2 pixel_mm{1.0};        ///< along the rows and the columns, 0.001 to 10
};

/// A 2D ultrasound image or clip in a DICOM file, without its pixels.
struct DicomUltrasound {
  int width = 0, height = 0;               ///< pixels
  std::size_t frames = 0;                  ///< at least 1
  std::optional<UltrasoundRegion> region;  ///< the largest one of 2D tissue with pixels in mm; empty if there is none
};

/// Reads the header of a DICOM file of ultrasound. Throws InputError if it is damaged, not ultrasound, or a volume.
DicomUltrasound read_dicom_ultrasound(const std::filesystem::path& file);

/// Decodes frames of such a file, in grey: 8 bits, colours as their luminance (BT.601). Throws InputError if the file
/// is damaged, or its pixels are not of 8 bits in grey, RGB, YBR_FULL, YBR_FULL_422 or a palette.
/// @param numbers  of the frames, from 0, below `frames`
std::vector<Image<std::uint8_t>> read_dicom_frames(const std::filesystem::path& file,
                                                   const std::vector<std::size_t>& numbers);

}  // namespace insonate
