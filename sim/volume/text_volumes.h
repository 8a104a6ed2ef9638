#pragma once

#include <filesystem>

#include "sim/core/grid.h"
#include "sim/volume/volume_header.h"

namespace insonate {

/// Reads the header of an NRRD file, attached (.nrrd) or detached (.nhdr), raw or gzip. The spaces LPS, RAS and LAS are
/// converted to LPS; others that have three dimensions are taken as LPS. Throws InputError as read_volume_header()
/// does, and for a field that NRRD does not have.
VolumeHeader read_nrrd_volume_header(const std::filesystem::path& file);

/// Reads the header of a MetaImage file, attached (.mha) or detached (.mhd), raw or zlib. Throws InputError as
/// read_volume_header() does.
VolumeHeader read_metaimage_volume_header(const std::filesystem::path& file);

/// Writes a raw NRRD file atomically. `voxels` are grid.count() numbers of `type`. ITK, 3D Slicer and teem
/// read the file. Throws InputError if it cannot be written.
void write_nrrd(const std::filesystem::path& file, const Grid& grid, ElementType type, const void* voxels);

}  // namespace insonate
