#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/core/grid.h"

namespace insonate {

/// The slices of one CT series in a folder of DICOM files, in the order of rising k on an upright grid.
struct DicomSeries {
  Grid grid;
  std::vector<std::filesystem::path> slices;  ///< grid.size.z files, each of one slice
  std::vector<std::string> other_series;      ///< one line each for what lies in the folder beside it
};

/// All files below a folder, in the order of their names. Throws InputError when there are more than `most` or the
/// folder cannot be read.
std::vector<std::string> files_below(const std::filesystem::path& folder, std::size_t most = 100000);

/// Looks through the folder and all below it, and takes the CT series with the most slices. Images of one series that
/// differ in size, orientation or pixel spacing, as localizers do, count as series of their own. Reads headers only.
/// Throws InputError when there is no CT series, a DICOM file is damaged, slices are missing, doubled, unevenly spaced
/// or shifted, or the gantry was tilted. Refuses a file by name that belongs to the series but is not part of it: an
/// empty or cut one, one that is not DICOM, and an image that differs from the rest where a slice is missing.
DicomSeries find_dicom_series(const std::filesystem::path& folder);

/// Reads one file's header as find_dicom_series does, and keeps nothing of it.
void scan_dicom_file(const std::filesystem::path& file);

/// Throws InputError when a file that find_dicom_series has found ends before its voxels do, is not shown as
/// MONOCHROME2 or does not give a rescale slope and intercept that can be a CT's.
void check_dicom_slice(const std::filesystem::path& file);

/// Whether a file carries DICOM's mark, "DICM" after 128 bytes.
bool is_dicom_file(const std::filesystem::path& file);

}  // namespace insonate
