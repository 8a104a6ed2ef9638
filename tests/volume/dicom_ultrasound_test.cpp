// Tests clips of DICOM ultrasound: their header, their pixels as grey, and files that cannot be used.

#include "sim/volume/dicom_ultrasound.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/core/temporary_folder.h"
#include "tests/volume/dicom_files.h"

using namespace insonate;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

struct Place {
  TemporaryFolder folder;
  fs::path file = folder.path / "clip.dcm";
  DicomClip clip;

  Place() { clip.stored = bytes(1); }
  std::vector<std::uint8_t> bytes(std::size_t samples) const {
    std::vector<std::uint8_t> values(samples * std::size_t(clip.columns * clip.rows * clip.frames));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::uint8_t(37 * i + i * i % 11);
    return values;
  }
  std::vector<Image<std::uint8_t>> frames(const std::vector<std::size_t>& numbers) const {
    write_dicom_clip(file, clip);
    return read_dicom_frames(file, numbers);
  }
  void refused(const std::string& sentence) const {
    CHECK_THROWS_WITH(read_dicom_frames(file, {0}), Contains("clip.dcm") && Contains(sentence));
  }
};

}  // namespace

TEST_CASE("a clip's header gives its size and its largest region of tissue") {
  Place place;
  write_dicom_clip(place.file, place.clip);
  DicomUltrasound clip = read_dicom_ultrasound(place.file);
  CHECK(clip.width == 8);
  CHECK(clip.height == 6);
  CHECK(clip.frames == 3);
  CHECK_FALSE(clip.region);
  DicomRegion spectrum{0, 0, 7, 5}, flow = spectrum, odd = spectrum, coarse = spectrum, empty{3, 2, 3, 4};
  spectrum.spatial_format = 3;
  flow.data_type = 2;
  odd.units = 4;  // s
  coarse.across_cm = 2;
  place.clip.regions = {spectrum, flow, odd, coarse, empty, {0, 0, 1, 1}, {2, 1, 6, 4}, {1, 1, 3, 3}};
  write_dicom_clip(place.file, place.clip);
  clip = read_dicom_ultrasound(place.file);
  REQUIRE(clip.region);
  CHECK(clip.region->rectangle == std::array{2, 1, 5, 4});
  CHECK(clip.region->pixel_mm.x == Approx(0.5));
  CHECK(clip.region->pixel_mm.y == Approx(0.4));
  place.clip.regions = {{0, 0, 8, 6}};  // the pixel behind the last one
  write_dicom_clip(place.file, place.clip);
  CHECK(read_dicom_ultrasound(place.file).region->rectangle == std::array{0, 0, 8, 6});
}

TEST_CASE("frames are read in grey, raw and compressed, in the order that is asked for") {
  Place place;
  const std::size_t of_image = 48;
  for (const DicomCoding coding : {DicomCoding::raw, DicomCoding::jpeg, DicomCoding::rle}) {
    place.clip.coding = coding;
    const auto frames = place.frames({2, 0});
    REQUIRE(frames.size() == 2);
    for (std::size_t i = 0; i < of_image; ++i) {
      CHECK(frames[0].pixels[i] == place.clip.stored[2 * of_image + i]);
      CHECK(frames[1].pixels[i] == place.clip.stored[i]);
    }
  }
}

TEST_CASE("colours are read as their luminance, however they are stored") {
  Place place;
  place.clip.stored = place.bytes(3);
  const auto stored = [&](std::size_t pixel, std::size_t sample) {
    return double(place.clip.stored[3 * (48 + pixel) + sample]);
  };
  for (const DicomColours colours : {DicomColours::rgb, DicomColours::rgb_planes, DicomColours::ybr})
    for (const DicomCoding coding : {DicomCoding::raw, DicomCoding::rle}) {
      place.clip.colours = colours;
      place.clip.coding = coding;
      const auto frames = place.frames({1});
      INFO(int(colours) << " " << int(coding));
      for (std::size_t i = 0; i < 48; ++i)
        CHECK(frames[0].pixels[i] ==
              (colours == DicomColours::ybr
                   ? stored(i, 0)
                   : std::lround(0.299 * stored(i, 0) + 0.587 * stored(i, 1) + 0.114 * stored(i, 2))));
    }
  place.clip.stored = place.bytes(1);
  place.clip.colours = DicomColours::palette;
  place.clip.coding = DicomCoding::raw;
  const auto frames = place.frames({1});
  for (std::size_t i = 0; i < 48; ++i) {
    const double n = place.clip.stored[48 + i];
    CHECK(frames[0].pixels[i] == std::lround(0.299 * (255 - n) + 0.587 * n + 0.114 * 7));
  }
}

TEST_CASE("DICOM files that are not clips of ultrasound are refused in a sentence") {
  Place place;
  write_dicom_clip(place.file, place.clip);
  set_tag(place.file, 0x0008, 0x0060, "CT");
  place.refused("its modality is CT, where ultrasound has US; name a clip of ultrasound");
  write_dicom_clip(place.file, place.clip);
  set_kind(place.file, "1.2.840.10008.5.1.4.1.1.6.2");
  place.refused("it is a volume, not a clip of 2D images; convert it to NRRD in 3D Slicer, and name that with --beam");
  write_dicom_clip(place.file, place.clip);
  set_tag(place.file, 0x0028, 0x0008, "0");
  place.refused("it claims 0 images of 8 x 6 pixels; export the clip again");
  write_dicom_clip(place.file, place.clip);
  set_tag(place.file, 0x0028, 0x0004, "MONOCHROME1");
  place.refused("its pixels are in MONOCHROME1");
  write_dicom_clip(place.file, place.clip);
  set_tag(place.file, 0x0028, 0x0100, std::string("\x10\0", 2));
  place.refused("its pixels are 16 bits large, which is not read here; export the clip as RGB or in grey, with 8 bits");
  const std::string damaged = "the DICOM file is damaged or cut off; export the clip again";
  write_dicom_clip(place.file, place.clip);
  remove_tag(place.file, 0x7fe0, 0x0010);
  place.refused(damaged);
  place.clip.coding = DicomCoding::rle;
  write_dicom_clip(place.file, place.clip);
  set_tag(place.file, 0x0028, 0x0008, "4");
  place.refused(damaged);
  // More images than memory holds.
  set_tag(place.file, 0x0028, 0x0008, "99999");
  for (const std::uint16_t side : {0x0010, 0x0011}) set_tag(place.file, 0x0028, side, std::string("\0\x20", 2));
  place.refused(damaged);
  place.clip.coding = DicomCoding::raw;
  place.clip.colours = DicomColours::palette;
  write_dicom_clip(place.file, place.clip);
  for (const std::uint16_t colour : {0x1201, 0x1202, 0x1203}) remove_tag(place.file, 0x0028, colour);
  place.refused(damaged);
  place.clip.colours = DicomColours::grey;
  // Every cut is noticed.
  write_dicom_clip(place.file, place.clip);
  const auto size = fs::file_size(place.file);
  for (const std::uintmax_t left : {size - 60, size - 144, size / 2, std::uintmax_t(200), std::uintmax_t(140)}) {
    write_dicom_clip(place.file, place.clip);
    fs::resize_file(place.file, left);
    INFO(left << " of " << size << " bytes");
    place.refused("");
  }
  place.folder.put("clip.dcm", "This is a text.");
  place.refused(damaged);
  fs::remove(place.file);
  place.refused("the file cannot be read; check its name");
}
