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

/// Looks through the folder and all below it, and takes the CT series with the most slices. Images of one series that
/// differ in size or orientation, as localizers do, count as series of their own. Reads headers only. Throws InputError
/// when there is no CT series, a DICOM file is damaged, slices are missing, doubled or unevenly spaced, or the gantry
/// was tilted.
DicomSeries find_dicom_series(const std::filesystem::path& folder);

/// Reads one file's header as find_dicom_series does, and keeps nothing of it.
void scan_dicom_file(const std::filesystem::path& file);

/// Throws InputError when a file that find_dicom_series has found ends before its voxels do.
void check_dicom_voxels(const std::filesystem::path& file);

/// Whether a file carries DICOM's mark, "DICM" after 128 bytes.
bool is_dicom_file(const std::filesystem::path& file);

}  // namespace insonate
