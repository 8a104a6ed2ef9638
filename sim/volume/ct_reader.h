#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sim/core/grid.h"

namespace insonate {

/// What was found where a person pointed, beside the voxels.
struct CtSource {
  std::string format;                     ///< "NIfTI", "NRRD", "MetaImage", "DICOM series"
  std::string stored_as;                  ///< the voxel type in the file: "int32"
  std::vector<std::string> other_series;  ///< DICOM: one line each for the series that were not taken
  std::size_t clamped = 0;                ///< voxels outside int16's or air's range that were brought back to it
  std::size_t too_dense = 0;              ///< those of them that were above int16's range
};

/// Reads a CT to Hounsfield units: a NIfTI (.nii, .nii.gz), NRRD (.nrrd, .nhdr) or MetaImage (.mha, .mhd) file, or a
/// DICOM folder, of which the series with the most slices is taken. Integers of 8 to 64 bits and floats are
/// accepted, rescale slope and intercept applied, and the direction matrix honoured; values are rounded and clamped
/// to [-1024, 32767].
/// Throws InputError for anything that is no 3D scalar volume of finite numbers with sides of at most 4096 voxels,
/// at most 2^31 voxels in all, positive spacing (1e-3 to 100 mm) and an invertible orthogonal direction matrix. Refuses
/// too what cannot be a person's CT: a side under 20 mm or over 3 m, a header that claims fewer bytes than the file
/// holds, and values that are all equal, all outside of what a body has (-300 to 3071 HU) or above int16's range in
/// more than a tenth of the voxels.
Volume<std::int16_t> read_ct(const std::filesystem::path& file_or_folder, CtSource* source = nullptr);

/// Reads the CT of a case, a file, in the same way, but of any size and density: a recipe may ask for a block of 10 mm
/// or of water alone.
Volume<std::int16_t> read_case_ct(const std::filesystem::path& file);

/// Reads a label volume: whole numbers from 0 to 255.
Volume<std::uint8_t> read_labels(const std::filesystem::path& file);

/// Writes NRRD files (raw, so that they read fast), atomically. Throws InputError.
void write_ct(const std::filesystem::path& nrrd_file, const Volume<std::int16_t>& ct);
void write_labels(const std::filesystem::path& nrrd_file, const Volume<std::uint8_t>& labels);

/// The CT on a grid of (about) `spacing_mm`, isotropic, axes as before, covering the same box. Cubic B-spline
/// interpolation, so that gradients between thick slices are smooth; overshoot beyond the neighbours' range is cut.
/// Returns the volume as it is when its spacing is already within 20 % of that. Throws InputError where that makes more
/// voxels than read_ct() takes.
/// @param file  what the person who gave the CT calls it
Volume<std::int16_t> resample_isotropic(const Volume<std::int16_t>& ct, double spacing_mm,
                                        const std::string& file = "the CT");

/// Labels carried onto another grid over the same patient, by nearest neighbour.
Volume<std::uint8_t> resample_labels(const Volume<std::uint8_t>& labels, const Grid& onto);

}  // namespace insonate
