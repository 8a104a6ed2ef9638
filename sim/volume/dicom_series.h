#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/core/grid.h"

namespace insonate {

/// The slices of one CT series in a folder of DICOM files, in the order of rising k on an upright grid.
struct DicomSeries {
  Grid grid;
  std::vector<std::filesystem::path> slices;  ///< grid.size.z files with one slice each
  std::vector<std::string> other_series;      ///< one text for each other series in the folder
};

/// Returns all files below a folder, sorted by name. Throws InputError if there are more than `most` or the folder
/// cannot be read.
std::vector<std::string> files_below(const std::filesystem::path& folder, std::size_t most = 100000);

/// Searches the folder and all below it, and returns the CT series with the most slices. Images of one series that
/// differ in size, orientation or pixel spacing, as localizers do, count as separate series. Reads headers only.
///
/// Throws InputError if there is no CT series, a DICOM file is damaged, slices are missing, doubled, unevenly spaced or
/// shifted, or the gantry was tilted. Also refuses, by name, a file that belongs to the series but cannot be part of
/// it: an empty or truncated file, one that is not DICOM, and an image that differs from the rest where a slice is
/// missing.
DicomSeries find_dicom_series(const std::filesystem::path& folder);

/// Reads one file's header as find_dicom_series() does, and discards the result.
void scan_dicom_file(const std::filesystem::path& file);

/// Throws InputError if a file found by find_dicom_series() ends before its voxels do, is not shown as MONOCHROME2, or
/// lacks a rescale slope and intercept that are plausible for a CT.
void check_dicom_slice(const std::filesystem::path& file);

/// Returns whether a file carries DICOM's prefix, "DICM" after 128 bytes.
bool is_dicom_file(const std::filesystem::path& file);

}  // namespace insonate
