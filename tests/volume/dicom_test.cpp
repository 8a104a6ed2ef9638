#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <fstream>
#include <functional>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/volume/ct_reader.h"
#include "tests/core/temporary_folder.h"
#include "tests/volume/dicom_files.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

constexpr int kSlices = 5;
constexpr double kGap_mm = 5;
const char* const kReport = "1.2.840.10008.5.1.4.1.1.88.11";
const char* const kEnhancedCtImage = "1.2.840.10008.5.1.4.1.1.2.1";

/// Slice `s` of a small series; its stored values tell voxel and slice apart.
DicomSlice small_slice(int s) {
  DicomSlice slice;
  slice.position = {-10, 20, 100 + s * kGap_mm};
  for (int v = 0; v < slice.columns * slice.rows; ++v) slice.stored.push_back(std::uint16_t(1000 + s * 100 + v));
  return slice;
}

std::int16_t expected_hu(int i, int j, int k) {
  return std::int16_t(1000 + k * 100 + j * 8 + i - 1024);
}

/// The file of slice `s`; the names are in an order that says nothing.
fs::path file_of(const fs::path& folder, int s) {
  return folder / ("IM" + std::to_string((s * 3 + 1) % kSlices));
}

/// Writes the series; `change` may alter or, returning false, leave out.
void write_series(const fs::path& folder, const std::function<bool(int, DicomSlice&)>& change = {}) {
  fs::create_directories(folder);
  for (int s = 0; s < kSlices; ++s) {
    DicomSlice slice = small_slice(s);
    if (!change || change(s, slice)) write_dicom(file_of(folder, s), slice);
  }
}

void check_voxels(const Volume<std::int16_t>& ct) {
  REQUIRE(ct.grid.size == glm::ivec3(8, 6, kSlices));
  bool same = true;
  for (int k = 0; k < kSlices; ++k)
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 8; ++i) same &= ct.at({i, j, k}) == expected_hu(i, j, k);
  CHECK(same);
}

std::string why_refused(const fs::path& folder) {
  try {
    read_ct(folder);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a DICOM series is the same volume in every coding") {
  for (const DicomCoding coding : {DicomCoding::raw, DicomCoding::big_endian, DicomCoding::jpeg, DicomCoding::jpeg_ls,
                                   DicomCoding::jpeg_2000, DicomCoding::rle}) {
    INFO("coding " << int(coding));
    const TemporaryFolder folder;
    write_series(folder.path, [&](int, DicomSlice& slice) {
      slice.coding = coding;
      return true;
    });
    CtSource source;
    const Volume<std::int16_t> ct = read_ct(folder.path, &source);
    CHECK(source.format == "DICOM series");
    CHECK(source.other_series.empty());
    check_voxels(ct);
    CHECK(glm::distance(ct.grid.spacing, glm::dvec3(3.5, 4, kGap_mm)) < 1e-9);
    CHECK(glm::distance(ct.grid.origin, glm::dvec3(-10, 20, 100)) < 1e-9);
  }
}

TEST_CASE("DICOM slices are rescaled each by its own slope and intercept") {
  const TemporaryFolder folder;
  write_series(folder.path, [&](int s, DicomSlice& slice) {
    if (s % 2) {
      slice.slope = 0.5;
      slice.intercept = -524;
      for (auto& value : slice.stored) value = std::uint16_t((value - 500) * 2);
    }
    return true;
  });
  check_voxels(read_ct(folder.path));
}

TEST_CASE("DICOM orientations are honoured, upright and oblique") {
  const TemporaryFolder folder;
  // Coronal: rows run to the left, columns to the feet, so the stack's normal runs to the back.
  write_series(folder.path / "coronal", [](int s, DicomSlice& slice) {
    slice.orientation = {1, 0, 0, 0, 0, -1};
    slice.position = {-10, 20 + s * kGap_mm, 100};
    return true;
  });
  const Volume<std::int16_t> coronal = read_ct(folder.path / "coronal");
  check_voxels(coronal);
  CHECK(glm::distance(coronal.grid.patient_from_index({1, 2, 3}), glm::dvec3(-6.5, 35, 92)) < 1e-6);

  const double tilt = glm::radians(20.0);
  write_series(folder.path / "oblique", [&](int s, DicomSlice& slice) {
    // As scanners write them: 6 decimals.
    const auto rounded = [](double x) { return std::round(x * 1e6) / 1e6; };
    slice.orientation = {1, 0, 0, 0, rounded(std::cos(tilt)), rounded(std::sin(tilt))};
    slice.position = {-10, 20 - s * kGap_mm * std::sin(tilt), 100 + s * kGap_mm * std::cos(tilt)};
    return true;
  });
  const Volume<std::int16_t> oblique = read_ct(folder.path / "oblique");
  check_voxels(oblique);
  CHECK(oblique.grid.spacing.z == Approx(kGap_mm));
  CHECK(glm::distance(oblique.grid.direction[2], glm::dvec3(0, -std::sin(tilt), std::cos(tilt))) < 1e-5);
}

TEST_CASE("of a mixed DICOM folder the largest CT series is taken and the others are named") {
  const TemporaryFolder folder;
  write_series(folder.path / "study" / "thin");
  write_series(folder.path / "study" / "thick", [](int s, DicomSlice& slice) {
    slice.series = "1.2.3.5";
    slice.series_number = "4";
    slice.description = "ABDOMEN 5.0";
    return s < 3;
  });
  write_series(folder.path / "study" / "localizer", [](int s, DicomSlice& slice) {
    slice.orientation = {0, 1, 0, 0, 0, -1};  // within the thin series, as some scanners file it
    return s < 1;
  });
  for (int s = 0; s < 2 * kSlices; ++s) {
    DicomSlice slice = small_slice(s);
    slice.series = "1.2.3.6";
    slice.series_number = "5";
    slice.description = "T2";
    slice.modality = "MR";
    write_dicom(folder.path / "study" / ("mr" + std::to_string(s)), slice);
  }
  std::ofstream(folder.path / "study" / "README.txt") << "Not an image.";
  fs::copy(folder.path / "study" / "thin" / "IM0", folder.path / "study" / "thin" / "IM0 (copy)");

  CtSource source;
  check_voxels(read_ct(folder.path, &source));
  REQUIRE(source.other_series.size() == 3);
  CHECK(source.other_series[0] == "series 5 'T2' (MR, 10 images of 8 x 6)");
  CHECK(source.other_series[1] == "series 4 'ABDOMEN 5.0' (CT, 3 images of 8 x 6)");
  CHECK(source.other_series[2] == "series 3 'ABDOMEN 1.0' (CT, 1 images of 8 x 6)");
}

TEST_CASE("a DICOM folder that gives no whole volume is refused with the reason") {
  using Change = std::function<bool(int, DicomSlice&)>;
  const struct {
    const char* sentence;
    Change change;
  } cases[] = {
      {"slices are missing between IM2 and IM3: 10 mm instead of 5 mm", [](int s, DicomSlice&) { return s != 3; }},
      {"unevenly spaced", [](int s, DicomSlice& slice) { return slice.position[2] += s == 2 ? 1 : 0, true; }},
      {"two slices lie at the same place",
       [](int s, DicomSlice& slice) {
         if (s == 2) slice.position[2] -= kGap_mm, slice.instance = "1.2.3.9";
         return true;
       }},
      {"the gantry was tilted: the stack leans by 15.0 degrees",
       [](int s, DicomSlice& slice) {
         slice.position[1] += s * kGap_mm * std::tan(glm::radians(15.0));
         return true;
       }},
      {"the slices are shifted sideways by 50 mm between IM2 and IM0",
       [](int s, DicomSlice& slice) { return slice.position[0] += s == 3 ? 50 : 0, true; }},
      {"header: the volume measures 28 x 24 x 0.025 mm, where a body has 20 to 3000 mm along each axis; is its spacing",
       [](int s, DicomSlice& slice) { return slice.position[2] = s * 0.005, true; }},
      {"voxels: all voxels have the same value, 60 HU",
       [](int, DicomSlice& slice) { return slice.stored.assign(48, 1084), true; }},
      {"this is not a CT", [](int, DicomSlice& slice) { return slice.modality = "MR", true; }},
      {"not a volume", [](int s, DicomSlice&) { return s == 0; }},
      {"not a volume", [](int s, DicomSlice& slice) { return slice.columns = 1, slice.rows = 48, s < 9; }},
      {"its pixel spacing is 4.5\\3.5, and 4\\3.5 in the rest of series 3",
       [](int s, DicomSlice& slice) { return slice.between_rows_mm = s == 4 ? 4.5 : 4, true; }},
  };
  for (const auto& bad : cases) {
    const TemporaryFolder folder;
    write_series(folder.path, bad.change);
    const std::string why = why_refused(folder.path);
    INFO(bad.sentence << " -> " << why);
    CHECK(why.find(bad.sentence) != std::string::npos);
    CHECK(why.find(folder.path.string()) == 0);
  }
  const auto without = [](std::uint16_t group, std::uint16_t element) {
    const TemporaryFolder folder;
    write_series(folder.path);
    for (int f = 0; f < kSlices; ++f) remove_tag(folder.path / ("IM" + std::to_string(f)), group, element);
    return why_refused(folder.path);
  };
  CHECK(without(0x0020, 0x0032).find("do not give their positions") != std::string::npos);
  CHECK(without(0x0020, 0x0037).find("the orientation of the slices is missing") != std::string::npos);
  const auto with_orientation = [](const std::string& orientation) {
    const TemporaryFolder folder;
    write_series(folder.path);
    for (int s = 0; s < kSlices; ++s) set_tag(file_of(folder.path, s), 0x0020, 0x0037, orientation);
    return why_refused(folder.path);
  };
  for (const char* bad : {"0\\0\\0\\0\\0\\0", "1\\0\\0\\0\\2\\0", "1\\0\\0\\0.6\\0.8\\0", "0\\0\\0\\0\\1\\0"})
    CHECK(with_orientation(bad).find(std::string("the orientation of the slices is ") + bad +
                                     ", which is not two perpendicular directions of length 1; export") !=
          std::string::npos);
  CHECK(without(0x0028, 0x0030).find("pixel spacing") != std::string::npos);
  INFO(without(0x7fe0, 0x0010));
  CHECK(without(0x7fe0, 0x0010).find("voxels") != std::string::npos);
}

TEST_CASE("a DICOM image that does not give Hounsfield units is refused by name") {
  using Change = std::function<void(const fs::path&)>;
  const auto set = [](std::uint16_t element, const std::string& text) {
    return [=](const fs::path& file) { set_tag(file, 0x0028, element, text); };
  };
  const struct {
    const char* sentence;
    Change change;
  } cases[] = {
      {"its rescale slope is missing and its rescale intercept -1024, so",
       [](const fs::path& file) { remove_tag(file, 0x0028, 0x1053); }},
      {"its rescale slope is 1 and its rescale intercept missing",
       [](const fs::path& file) { remove_tag(file, 0x0028, 0x1052); }},
      {"its rescale slope is missing and its rescale intercept missing", set(0x1052, "")},
      {"and its rescale intercept nan", set(0x1052, "nan")},
      {"its rescale slope is nan", set(0x1053, "nan")},
      {"its rescale slope is one", set(0x1053, "one")},
      {"its rescale slope is 1\\2", set(0x1053, "1\\2")},
      {"its rescale slope is 1e400 and", set(0x1053, "1e400")},
      {"its rescale slope is 1e+30, where a CT has one from 1e-09 to 10000", set(0x1053, "1e30")},
      {"its rescale slope is 0, where", set(0x1053, "0")},
      {"its rescale slope is -1, where", set(0x1053, "-1")},
      {"its rescale intercept is 1e+30, where a CT has one within +-100000", set(0x1052, "1e30")},
      {"its photometric interpretation is MONOCHROME1, where a CT has MONOCHROME2", set(0x0004, "MONOCHROME1")},
      {"its photometric interpretation is PALETTE COLOR", set(0x0004, "PALETTE COLOR")},
      {"its photometric interpretation is missing", set(0x0004, "")},
      {"its rescale slope and intercept are not where its kind of image has them",
       [](const fs::path& file) { move_rescale(file, 0x9229); }},
  };
  for (const auto& bad : cases)
    for (const int s : {0, 2, kSlices - 1}) {
      const TemporaryFolder folder;
      write_series(folder.path);
      const fs::path file = file_of(folder.path, s);
      if (std::string(bad.sentence).find("slope is missing and its rescale intercept missing") != std::string::npos)
        set_tag(file, 0x0028, 0x1053, "");
      bad.change(file);
      const std::string why = why_refused(folder.path);
      INFO(bad.sentence << " in slice " << s << " -> " << why);
      CHECK(why.find(file.string() + ": header: ") == 0);
      CHECK(why.find(bad.sentence) != std::string::npos);
    }
}

TEST_CASE("an enhanced DICOM image of one frame has its rescale in its functional groups") {
  for (const std::uint16_t groups : {0x9229, 0x9230}) {
    const TemporaryFolder folder;
    write_series(folder.path);
    for (int s = 0; s < kSlices; ++s) {
      set_kind(file_of(folder.path, s), kEnhancedCtImage);
      move_rescale(file_of(folder.path, s), groups);
    }
    INFO(why_refused(folder.path));
    check_voxels(read_ct(folder.path));
  }
}

TEST_CASE("enhanced DICOM images with their positions in groups, or several in a file, are refused as such") {
  const TemporaryFolder folder;
  write_series(folder.path);
  for (int s = 0; s < kSlices; ++s) {
    set_kind(file_of(folder.path, s), kEnhancedCtImage);
    remove_tag(file_of(folder.path, s), 0x0020, 0x0032);
  }
  CHECK(why_refused(folder.path).find("these are enhanced images, which may hold several slices per file; convert") !=
        std::string::npos);
}

TEST_CASE("no image of a DICOM series is left out without a word, whichever it is") {
  const auto cut_to = [](const fs::path& file, std::size_t size) {
    const std::string bytes = read_file(file).substr(0, size);
    fs::remove(file);
    std::ofstream(file, std::ios::binary) << bytes;
  };
  const auto position_of = [](const fs::path& file, const std::string& tag) { return read_file(file).find(tag); };
  using Change = std::function<void(const fs::path&)>;
  const struct {
    const char* sentence;
    Change change;
  } cases[] = {
      {": the file is empty, but it is named like the images of series 3", [&](const fs::path& f) { cut_to(f, 0); }},
      {": this is not a DICOM file, but it is named like", [&](const fs::path& f) { cut_to(f, 100); }},
      {": this is not a DICOM file, but it is named like",
       [](const fs::path& f) { std::ofstream(f) << "Dear radiologist, please find enclosed the scan."; }},
      {": the DICOM file is damaged", [&](const fs::path& f) { cut_to(f, 132); }},
      {": the DICOM file is damaged", [&](const fs::path& f) { cut_to(f, 200); }},
      {"header: the DICOM file is damaged or cut off before its image",
       [&](const fs::path& f) {
         cut_to(f, position_of(f, {"\x28\0\x10\0US", 6}));
       }},
      {"header: the DICOM file is damaged or cut off before its image",
       [&](const fs::path& f) {
         cut_to(f, position_of(f, {"\x28\0\x11\0US", 6}));
       }},
      {"header: its pixel spacing is missing, and 4\\3.5 in the rest of series 3",
       [&](const fs::path& f) {
         cut_to(f, position_of(f, {"\x28\0\x30\0", 4}));
       }},
      {"voxels: it holds no image of the size that its header gives",
       [&](const fs::path& f) {
         cut_to(f, position_of(f, {"\xe0\x7f\x10\0", 4}));
       }},
      {"voxels: the file ends before its image does", [&](const fs::path& f) { cut_to(f, fs::file_size(f) - 1); }},
      {"header: its size is 7 x 6, and 8 x 6 in the rest of series 3",
       [](const fs::path& f) { set_tag(f, 0x0028, 0x0011, std::string("\7\0", 2)); }},
      {"header: its orientation is 1\\0\\0\\0\\0.866\\0.5, and 1\\0\\0\\0\\1\\0 in the rest of series 3",
       [](const fs::path& f) { set_tag(f, 0x0020, 0x0037, "1\\0\\0\\0\\0.866\\0.5"); }},
      {"header: its orientation is 0\\0\\0\\0\\0\\0, and",
       [](const fs::path& f) { set_tag(f, 0x0020, 0x0037, "0\\0\\0\\0\\0\\0"); }},
      {"header: its orientation is missing, and", [](const fs::path& f) { remove_tag(f, 0x0020, 0x0037); }},
      {"header: its pixel spacing is 4\\4, and", [](const fs::path& f) { set_tag(f, 0x0028, 0x0030, "4\\4"); }},
      {"header: it does not give its position, as the rest of series 3",
       [](const fs::path& f) { set_tag(f, 0x0020, 0x0032, "nan\\0\\0"); }},
  };
  for (const auto& bad : cases)
    for (const int s : {0, 2, kSlices - 1}) {
      const TemporaryFolder folder;
      write_series(folder.path);
      const fs::path file = file_of(folder.path, s);
      bad.change(file);
      const std::string why = why_refused(folder.path);
      INFO(bad.sentence << " in slice " << s << " -> " << why);
      CHECK(why.find(file.string() + ": ") == 0);
      CHECK(why.find(bad.sentence) != std::string::npos);
    }
}

TEST_CASE("what only lies beside a DICOM series does not keep it from being read") {
  const TemporaryFolder folder;
  write_series(folder.path);
  for (int s = 0; s < kSlices; ++s) fs::rename(file_of(folder.path, s), file_of(folder.path, s).string() + ".dcm");
  // An operating system's notes, an empty marker, a report and a directory: the last two are DICOM without an image.
  folder.put("._IM0.dcm", "");
  folder.put("VERSION", "");
  fs::create_directories(folder.path / "notes");
  folder.put("notes/empty.dcm", "");
  DicomSlice slice = small_slice(0);
  slice.modality = "SR";
  write_dicom(folder.path / "report.dcm", slice);
  set_kind(folder.path / "report.dcm", kReport);
  for (const std::uint16_t element : {0x0010, 0x0011}) remove_tag(folder.path / "report.dcm", 0x0028, element);
  slice.modality = "CT";
  // The same acquisition in another field of view, within the series.
  for (int s = 0; s < 3; ++s) {
    slice = small_slice(s);
    slice.between_rows_mm = 2;
    slice.instance = "1.2.3.7." + std::to_string(s);
    write_dicom(folder.path / ("zoom" + std::to_string(s)), slice);
  }
  // Directions and spacing in other words.
  set_tag(folder.path / "IM2.dcm", 0x0020, 0x0037, "1.0\\0.0\\0.0\\0\\1\\-0.0000001");
  set_tag(folder.path / "IM2.dcm", 0x0028, 0x0030, "4.00\\3.50");
  INFO(why_refused(folder.path));
  CtSource source;
  check_voxels(read_ct(folder.path, &source));
  REQUIRE(source.other_series.size() == 1);
  CHECK(source.other_series[0] == "series 3 'ABDOMEN 1.0' (CT, 3 images of 8 x 6)");

  folder.put("lost.dcm", "");
  CHECK(why_refused(folder.path).find((folder.path / "lost.dcm").string() + ": the file is empty") == 0);
}

TEST_CASE("a DICOM image in a coding that is not read here is refused by name") {
  const TemporaryFolder folder;
  write_series(folder.path, [](int, DicomSlice& slice) { return slice.coding = DicomCoding::jpeg, true; });
  const fs::path file = file_of(folder.path, 0);
  const std::string good = read_file(file);
  const auto with = [&](const std::string& what, const std::string& by) {
    const auto at = good.find(what);
    REQUIRE(at != std::string::npos);
    folder.put(file.filename().string(), std::string(good).replace(at, by.size(), by));
    const std::string why = why_refused(folder.path);
    INFO(why);
    CHECK(why.find(file.string() + ": ") == 0);
    return why;
  };
  // JPEG lossless becomes MPEG2, a video.
  CHECK(with("1.2.840.10008.1.2.4.70", std::string("1.2.840.10008.1.2.4.100").substr(0, 22) + "0").find("header") !=
        std::string::npos);
  // The marker that begins the compressed image is lost.
  CHECK(with("\xff\xd8\xff", std::string("\0\0\0", 3)).find("; export it again, uncompressed.") != std::string::npos);
}

TEST_CASE("a DICOM image of 64 bits per pixel is refused by name") {
  const TemporaryFolder folder;
  write_series(folder.path, [](int, DicomSlice& slice) { return slice.coding = DicomCoding::rle, true; });
  const fs::path file = file_of(folder.path, 0);
  for (const std::uint16_t element : {0x0100, 0x0101}) set_tag(file, 0x0028, element, std::string("\x40\0", 2));
  set_tag(file, 0x0028, 0x0102, std::string("\x3f\0", 2));
  CHECK(why_refused(folder.path) == file.string() +
                                        ": header: the header of its image is damaged or of a kind that is not read "
                                        "here; export it again, uncompressed.");
}

TEST_CASE("a DICOM file cut anywhere or with bytes changed gives a volume or a reason") {
  for (const DicomCoding coding : {DicomCoding::raw, DicomCoding::big_endian, DicomCoding::jpeg, DicomCoding::jpeg_ls,
                                   DicomCoding::jpeg_2000, DicomCoding::rle}) {
    INFO("coding " << int(coding));
    const TemporaryFolder folder;
    write_series(folder.path, [&](int, DicomSlice& slice) {
      slice.coding = coding;
      return true;
    });
    const std::string good = read_file(folder.path / "IM2");
    for (std::size_t part = 1; part < 16; ++part) {
      INFO("the first " << part << "/16");
      folder.put("IM2", good.substr(0, good.size() * part / 16));
      CHECK_FALSE(why_refused(folder.path).empty());
    }
    std::uint32_t state = 1;
    const auto random = [&](std::size_t below) {
      return std::size_t((state = state * 1664525u + 1013904223u) >> 8) % below;
    };
    int refused = 0;
    constexpr int kRounds = 60;
    for (int round = 0; round < kRounds; ++round) {
      std::string bytes = good;
      for (std::size_t flips = 1 + random(3); flips > 0; --flips) bytes[random(bytes.size())] = char(random(256));
      folder.put("IM2", bytes);
      refused += !why_refused(folder.path).empty();
    }
    CHECK(refused > 0);
    CHECK(refused < kRounds);
  }
}
