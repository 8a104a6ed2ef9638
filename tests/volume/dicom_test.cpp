#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <fstream>
#include <functional>

#include "sim/core/files.h"
#include "sim/core/input_error.h"
#include "sim/volume/ct_reader.h"
#include "tests/volume/dicom_files.h"
#include "tests/volume/temporary_folder.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

constexpr int kSlices = 5;
constexpr double kGapMm = 2.5;

/// Slice `s` of a small series; its stored values tell voxel and slice apart.
DicomSlice small_slice(int s) {
  DicomSlice slice;
  slice.position = {-10, 20, 100 + s * kGapMm};
  for (int v = 0; v < slice.columns * slice.rows; ++v) slice.stored.push_back(std::uint16_t(1000 + s * 100 + v));
  return slice;
}

std::int16_t expected_hu(int i, int j, int k) {
  return std::int16_t(1000 + k * 100 + j * 8 + i - 1024);
}

/// Writes the series with file names in an order that says nothing; `change` may alter or, returning false, leave out.
void write_series(const fs::path& folder, const std::function<bool(int, DicomSlice&)>& change = {}) {
  fs::create_directories(folder);
  for (int s = 0; s < kSlices; ++s) {
    DicomSlice slice = small_slice(s);
    if (!change || change(s, slice)) write_dicom(folder / ("IM" + std::to_string((s * 3 + 1) % kSlices)), slice);
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
  for (const DicomCoding coding :
       {DicomCoding::raw, DicomCoding::jpeg, DicomCoding::jpeg_ls, DicomCoding::jpeg_2000, DicomCoding::rle}) {
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
    CHECK(glm::distance(ct.grid.spacing, glm::dvec3(0.7, 0.8, kGapMm)) < 1e-9);
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
    slice.position = {-10, 20 + s * kGapMm, 100};
    return true;
  });
  const Volume<std::int16_t> coronal = read_ct(folder.path / "coronal");
  check_voxels(coronal);
  CHECK(glm::distance(coronal.grid.patient_from_index({1, 2, 3}), glm::dvec3(-9.3, 27.5, 98.4)) < 1e-6);

  const double tilt = glm::radians(20.0);
  write_series(folder.path / "oblique", [&](int s, DicomSlice& slice) {
    // As scanners write them: 6 decimals.
    const auto rounded = [](double x) { return std::round(x * 1e6) / 1e6; };
    slice.orientation = {1, 0, 0, 0, rounded(std::cos(tilt)), rounded(std::sin(tilt))};
    slice.position = {-10, 20 - s * kGapMm * std::sin(tilt), 100 + s * kGapMm * std::cos(tilt)};
    return true;
  });
  const Volume<std::int16_t> oblique = read_ct(folder.path / "oblique");
  check_voxels(oblique);
  CHECK(oblique.grid.spacing.z == Approx(kGapMm));
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
    const char* told;
    Change change;
  } cases[] = {
      {"slices are missing between IM2 and IM3: 5 mm instead of 2.5 mm", [](int s, DicomSlice&) { return s != 3; }},
      {"unevenly spaced", [](int s, DicomSlice& slice) { return slice.position[2] += s == 2 ? 0.5 : 0, true; }},
      {"two slices lie at the same place",
       [](int s, DicomSlice& slice) {
         if (s == 2) slice.position[2] -= kGapMm, slice.instance = "1.2.3.9";
         return true;
       }},
      {"the gantry was tilted: the stack leans by 15.0 degrees",
       [](int s, DicomSlice& slice) {
         slice.position[1] += s * kGapMm * std::tan(glm::radians(15.0));
         return true;
       }},
      {"this is no CT", [](int, DicomSlice& slice) { return slice.modality = "MR", true; }},
      {"no volume", [](int s, DicomSlice&) { return s == 0; }},
      {"no volume", [](int s, DicomSlice& slice) { return slice.columns = 1, slice.rows = 48, s < 9; }},
      {"pixel spacing differs",
       [](int s, DicomSlice& slice) { return slice.between_rows_mm = s == 4 ? 0.9 : 0.8, true; }},
  };
  for (const auto& bad : cases) {
    const TemporaryFolder folder;
    write_series(folder.path, bad.change);
    const std::string why = why_refused(folder.path);
    INFO(bad.told << " -> " << why);
    CHECK(why.find(bad.told) != std::string::npos);
    CHECK(why.find(folder.path.string()) == 0);
  }
  const auto without = [](std::uint16_t group, std::uint16_t element) {
    const TemporaryFolder folder;
    write_series(folder.path);
    for (int f = 0; f < kSlices; ++f) remove_tag(folder.path / ("IM" + std::to_string(f)), group, element);
    return why_refused(folder.path);
  };
  CHECK(without(0x0020, 0x0032).find("do not say where they lie") != std::string::npos);
  CHECK(without(0x0020, 0x0037).find("how they are oriented") != std::string::npos);
  CHECK(without(0x0028, 0x0030).find("pixel spacing") != std::string::npos);
  INFO(without(0x7fe0, 0x0010));
  CHECK(without(0x7fe0, 0x0010).find("voxels") != std::string::npos);
}

TEST_CASE("a DICOM file cut anywhere or with bytes changed gives a volume or a reason") {
  for (const DicomCoding coding :
       {DicomCoding::raw, DicomCoding::jpeg, DicomCoding::jpeg_ls, DicomCoding::jpeg_2000, DicomCoding::rle}) {
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
