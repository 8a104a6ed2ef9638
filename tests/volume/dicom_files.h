#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace insonate {

enum class DicomCoding { raw, jpeg, jpeg_ls, jpeg_2000, rle, big_endian };

/// One slice of a DICOM series as a scanner would store it, written by GDCM.
struct DicomSlice {
  std::string series = "1.2.3.4";
  std::string instance;  ///< derived from series and position if empty
  std::string series_number = "3";
  std::string description = "ABDOMEN 1.0";
  std::string modality = "CT";
  int columns = 8, rows = 6;
  std::array<double, 3> position{0, 0, 0};
  std::array<double, 6> orientation{1, 0, 0, 0, 1, 0};
  double between_columns_mm = 3.5, between_rows_mm = 4;
  double slope = 1, intercept = -1024;
  std::vector<std::uint16_t> stored;  ///< rows x columns
  DicomCoding coding = DicomCoding::raw;
};

void write_dicom(const std::filesystem::path& file, const DicomSlice& slice);

/// Replaces the bytes of an existing element of a DICOM file.
void set_tag(const std::filesystem::path& file, std::uint16_t group, std::uint16_t element, const std::string& bytes);

/// Changes the kind of a DICOM file through its SOP class.
void set_kind(const std::filesystem::path& file, const std::string& sop_class);

/// Moves a file's rescale values from the top of its data set to the functional groups (5200,`groups`), shared (9229)
/// or per frame (9230), where enhanced images have them.
void move_rescale(const std::filesystem::path& file, std::uint16_t groups);

/// Removes a tag from a DICOM file.
void remove_tag(const std::filesystem::path& file, std::uint16_t group, std::uint16_t element);

}  // namespace insonate
