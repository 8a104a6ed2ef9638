#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sim/core/grid.h"

namespace insonate {

/// Describes the source of a CT, besides its voxels.
struct CtSource {
  std::string format;                     ///< "NIfTI", "NRRD", "MetaImage", "DICOM series"
  std::string stored_as;                  ///< the voxel type in the file: "int32"
  std::vector<std::string> other_series;  ///< DICOM: one text for each series that was not read
  std::size_t clamped = 0;                ///< voxels that were clamped to the range of air or of int16
  std::size_t too_dense = 0;              ///< the part of these that was above the range of int16
  std::size_t rounded = 0;                ///< voxels whose values were not whole numbers
};

/// Reads a CT and returns it in Hounsfield units. The source is a NIfTI (.nii, .nii.gz), NRRD (.nrrd, .nhdr) or
/// MetaImage (.mha, .mhd) file, or a DICOM folder, of which the series with the most slices is read. Accepts integers
/// of 8 to 64 bits and floats; applies the rescale slope and intercept; honours the direction matrix. Values are
/// rounded and clamped to [-1024, 32767].
///
/// Throws InputError for input that is not a 3D scalar volume of finite numbers with at most 4096 voxels per side, at
/// most 2^31 voxels in all, positive spacing (1e-3 to 100 mm) and an invertible orthogonal direction matrix. Also
/// refuses what cannot be a person's CT: a side below 20 mm or above 3 m; a header that claims fewer or more bytes than
/// the file holds; values that are all equal or all outside a body's range (-300 to 3071 HU); values above int16's
/// range in more than a tenth of the voxels; and a label map, which has few values, all whole numbers from 0 to 255.
Volume<std::int16_t> read_ct(const std::filesystem::path& file_or_folder, CtSource* source = nullptr);

/// Reads the CT file of a case in the same way, but accepts any size and density: a recipe may ask for a block of 10 mm
/// or for water alone.
Volume<std::int16_t> read_case_ct(const std::filesystem::path& file);

/// Reads a label volume in the same file formats. Throws InputError for values that are not whole numbers from 0 to
/// 255.
Volume<std::uint8_t> read_labels(const std::filesystem::path& file);

/// Writes a raw NRRD file, which is fast to read, atomically. Throws InputError.
void write_ct(const std::filesystem::path& nrrd_file, const Volume<std::int16_t>& ct);
void write_labels(const std::filesystem::path& nrrd_file, const Volume<std::uint8_t>& labels);

/// Returns the CT on an isotropic grid of about `spacing_mm`, with the same axes and box. Uses cubic B-spline
/// interpolation, so that gradients between thick slices are smooth, and clamps overshoot to the range of the
/// neighbours. Returns the volume unchanged if its spacing is already within 20 % of `spacing_mm`. Throws InputError if
/// the result has more voxels than read_ct() accepts.
/// @param file  the CT's name in error messages
Volume<std::int16_t> resample_isotropic(const Volume<std::int16_t>& ct, double spacing_mm,
                                        const std::string& file = "the CT");

/// Returns the labels on another grid over the same patient; 0 outside theirs.
///
/// A voxel takes the label with the largest sum of weights around it. The weights are the mean of linear
/// interpolation's and the cubic B-spline's. The spline's would make surfaces without the old voxels' steps, but would
/// lose what is one voxel thin; linear interpolation keeps that, and steps. A voxel at an old voxel's middle keeps its
/// label.
Volume<std::uint8_t> resample_labels(const Volume<std::uint8_t>& labels, const Grid& onto);

}  // namespace insonate
