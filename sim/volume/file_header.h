#pragma once

#include <glm/vec3.hpp>

#include <filesystem>
#include <string>

#include "sim/volume/itk_image_io.h"

namespace insonate {

/// Holds what a volume file's own header states, read before ITK opens the file.
struct FileHeader {
  ImageFormat format = ImageFormat::nifti;
  std::string stored_as;  ///< the voxel type on disk, before any rescale: "int32"
  glm::ivec3 size{0};
  glm::dvec3 spacing{0.0};  ///< mm
};

/// Reads the header of a NIfTI, NRRD or MetaImage file, chosen by the file name's ending. Checks its claims against the
/// limits and against the bytes in the file. ITK's parsers trust a header: they allocate what it claims, fill missing
/// voxels with zeros, and replace a spacing of 0 by 1. Throws InputError.
FileHeader check_file_header(const std::filesystem::path& file);

}  // namespace insonate
