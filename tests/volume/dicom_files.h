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

/// One item of a clip's Sequence of Ultrasound Regions: tissue in 2D, with pixels of 0.5 x 0.4 mm.
struct DicomRegion {
  std::uint32_t left = 0, top = 0, right = 0, bottom = 0;  ///< first and last pixels
  std::uint16_t spatial_format = 1, data_type = 1, units = 3;
  double across_cm = 0.05, down_cm = 0.04;
};

/// How a clip's pixels are stored: in grey, as colours pixel by pixel or plane by plane, or as indices into a palette.
enum class DicomColours { grey, rgb, rgb_planes, ybr, palette };

/// A multi-frame ultrasound clip as a scanner would export it, written by GDCM.
struct DicomClip {
  int columns = 8, rows = 6, frames = 3;
  DicomColours colours = DicomColours::grey;
  /// Frame by frame, and with colours 3 per pixel: red, green, blue for each pixel (also where they are stored by
  /// planes), or luminance and chrominances. The palette has red 255 - n, green n and blue 7 at n.
  std::vector<std::uint8_t> stored;
  std::vector<DicomRegion> regions;
  DicomCoding coding = DicomCoding::raw;
};

void write_dicom_clip(const std::filesystem::path& file, const DicomClip& clip);

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
