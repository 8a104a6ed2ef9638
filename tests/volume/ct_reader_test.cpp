#include "sim/volume/ct_reader.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/volume/text_volumes.h"
#include "tests/core/temporary_folder.h"
#include "tests/volume/volume_files.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

double most_apart(const glm::dmat4& a, const glm::dmat4& b) {
  double worst = 0;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) worst = std::max(worst, std::abs(a[c][r] - b[c][r]));
  return worst;
}

/// The 24 voxels of every small file here.
template <typename T>
std::vector<T> counting() {
  std::vector<T> values(24);
  std::iota(values.begin(), values.end(), T(0));
  return values;
}

std::vector<std::int16_t> hu_counting() {
  return counting<std::int16_t>();
}

Volume<std::int16_t> read_bytes(const TemporaryFolder& folder, const std::string& name, const std::string& bytes,
                                CtSource* source = nullptr) {
  folder.put(name, bytes);
  return read_ct(folder.path / name, source);
}

struct StoredType {
  const char *name, *nrrd, *meta;
  std::int16_t nifti;
  std::string bytes, swapped;
};

template <typename T>
StoredType stored_type(const char* name, const char* nrrd, const char* meta, std::int16_t nifti) {
  return {name, nrrd, meta, nifti, bytes_of_values(counting<T>()), swapped_bytes_of_values(counting<T>())};
}

std::vector<StoredType> stored_types() {
  return {stored_type<std::int8_t>("int8", "int8", "MET_CHAR", 256),
          stored_type<std::uint8_t>("uint8", "uchar", "MET_UCHAR", 2),
          stored_type<std::int16_t>("int16", "short", "MET_SHORT", 4),
          stored_type<std::uint16_t>("uint16", "unsigned short", "MET_USHORT", 512),
          stored_type<std::int32_t>("int32", "int", "MET_INT", 8),
          stored_type<std::uint32_t>("uint32", "uint32_t", "MET_UINT", 768),
          stored_type<std::int64_t>("int64", "int64", "MET_LONG_LONG", 1024),
          stored_type<std::uint64_t>("uint64", "unsigned long long", "MET_ULONG_LONG", 1280),
          stored_type<float>("float32", "float", "MET_FLOAT", 16),
          stored_type<double>("float64", "double", "MET_DOUBLE", 64)};
}

}  // namespace

TEST_CASE("MetaImage's long is read as the four bytes that it has on every machine") {
  const TemporaryFolder folder;
  const std::string four_bytes = bytes_of_values(counting<std::int32_t>());
  for (const char* name : {"MET_INT", "MET_LONG"}) {
    const auto lines = with_line(meta_lines(), "ElementType", std::string("ElementType = ") + name);
    CHECK(read_bytes(folder, "a.mha", meta_image(lines, four_bytes)).voxels.size() == 24);
  }
}

TEST_CASE("each format gives the same volume whatever the type, byte order and packing of its voxels") {
  const TemporaryFolder folder;
  const bool big_endian = GENERATE(false, true);
  for (StoredType type : stored_types()) {
    if (big_endian) type.bytes = type.swapped;
    NiftiSpec spec;
    spec.big_endian = big_endian;
    spec.datatype = type.nifti;
    spec.bits = std::int16_t(type.bytes.size() / 24 * 8);
    const auto nrrd_with = [&](const std::string& encoding) {
      const auto lines = with_line(nrrd_lines(), "endian", big_endian ? "endian: big" : "endian: little");
      return with_line(with_line(lines, "type", std::string("type: ") + type.nrrd), "encoding",
                       "encoding: " + encoding);
    };
    const std::string meta_type = std::string("ElementType = ") + type.meta, zipped = zlib(type.bytes);
    const auto meta_with = [&](const std::vector<std::string>& lines, const std::string& order) {
      return with_line(with_line(lines, "ElementType", meta_type), "BinaryDataByteOrderMSB",
                       order + (big_endian ? " = True" : " = False"));
    };
    const auto meta = meta_with(meta_lines(), "BinaryDataByteOrderMSB");
    const auto packed_meta = meta_with(packed_meta_lines(zipped), "ElementByteOrderMSB");
    folder.put("apart.raw", type.bytes);
    folder.put("apart.zraw", zipped);
    const struct {
      std::string file, bytes, format;
    } files[] = {
        {"a.nii", nifti(spec, type.bytes), "NIfTI"},
        {"a.nii.gz", gzip(nifti(spec, type.bytes)), "NIfTI"},
        {"A.NII", nifti(spec, type.bytes), "NIfTI"},
        {"b.nii", nifti_2(spec, type.bytes), "NIfTI"},
        {"b.nii.gz", gzip(nifti_2(spec, type.bytes)), "NIfTI"},
        {"a.nrrd", nrrd(nrrd_with("raw"), type.bytes), "NRRD"},
        {"b.nrrd", nrrd(nrrd_with("gzip"), gzip(type.bytes)), "NRRD"},
        {"a.nhdr", nrrd(with_line(nrrd_with("raw"), "data file", "data file: apart.raw"), ""), "NRRD"},
        {"a.mha", meta_image(meta, type.bytes), "MetaImage"},
        {"b.mha", meta_image(packed_meta, zipped), "MetaImage"},
        {"a.mhd", meta_image(meta, "", "apart.raw"), "MetaImage"},
        {"b.mhd", meta_image(packed_meta, "", "apart.zraw"), "MetaImage"},
    };
    for (const auto& file : files) {
      INFO(type.name << " in " << file.file << (big_endian ? ", big-endian" : ""));
      CtSource source;
      const Volume<std::int16_t> ct = read_bytes(folder, file.file, file.bytes, &source);
      CHECK(source.format == file.format);
      CHECK(source.stored_as == type.name);
      CHECK(source.clamped == 0);
      CHECK(ct.grid.size == glm::ivec3(4, 3, 2));
      CHECK(glm::distance(ct.grid.spacing, glm::dvec3(10, 20, 30)) < 1e-9);
      CHECK(ct.voxels == hu_counting());
    }
  }
}

TEST_CASE("values are rescaled, rounded and brought into the Hounsfield range") {
  const TemporaryFolder folder;
  NiftiSpec spec;
  spec.slope = 50;
  spec.inter = -1000;
  CtSource source;
  auto ct = read_bytes(folder, "a.nii", nifti(spec, bytes_of_values(hu_counting())), &source);
  CHECK(source.stored_as == "int16");
  for (std::size_t v = 0; v < 24; ++v) CHECK(ct.voxels[v] == int(v) * 50 - 1000);

  std::vector<double> values(24, 0.0);
  values[0] = -3024;  // what some scanners write outside their field of view
  values[1] = 1e9;
  values[2] = 59.6;
  values[3] = -59.6;
  values[4] = -1024;
  ct = read_bytes(folder, "a.nrrd", nrrd(with_line(nrrd_lines(), "type", "type: double"), bytes_of_values(values)),
                  &source);
  CHECK(source.clamped == 2);
  CHECK(ct.voxels[0] == -1024);
  CHECK(ct.voxels[1] == 32767);
  CHECK(ct.voxels[2] == 60);
  CHECK(ct.voxels[3] == -60);
  CHECK(ct.voxels[4] == -1024);
}

TEST_CASE("a NIfTI rescale of integers has single precision, and one of doubles has double") {
  const TemporaryFolder folder;
  // Single precision rounds 2^24 + 1 to 2^24. The rescale makes 0.5 of the one, and 0.496 of the other.
  const std::vector<std::int32_t> whole(24, 16777217);
  NiftiSpec spec;
  spec.slope = 1 / 256.0f;
  spec.inter = -65535.50390625f;
  spec.datatype = 8;
  folder.put("a.nii", nifti(spec, bytes_of_values(whole)));
  CHECK(read_case_ct(folder.path / "a.nii").voxels[0] == 0);
  spec.datatype = 64;
  folder.put("b.nii", nifti(spec, bytes_of_values(std::vector<double>(whole.begin(), whole.end()))));
  CHECK(read_case_ct(folder.path / "b.nii").voxels[0] == 1);
}

TEST_CASE("an NRRD without a space is placed by its spacings and the ends of its axes") {
  const TemporaryFolder folder;
  auto lines = with_line(with_line(nrrd_lines(), "space directions", "spacings: 10 20 30"), "space origin", "");
  lines = with_line(lines, "space: ", "");
  const auto origin = [&](const std::vector<std::string>& with) {
    const Grid grid = read_bytes(folder, "a.nrrd", nrrd(with, bytes_of_values(hu_counting()))).grid;
    CHECK(grid.spacing == glm::dvec3(10, 20, 30));
    CHECK(grid.direction == glm::dmat3(1.0));
    return grid.origin;
  };
  CHECK(origin(lines) == glm::dvec3(0, 0, 0));
  lines = with_line(lines, "axis mins", "axis mins: 1 2 3");
  CHECK(origin(lines) == glm::dvec3(6, 12, 18));
  CHECK(origin(with_line(lines, "centers", "centers: cell node ???")) == glm::dvec3(6, 2, 18));
  CHECK(origin(with_line(lines, "axismaxs", "axismaxs: 40 60 60")) == glm::dvec3(6, 12, 18));
}

TEST_CASE("an NRRD's spaces, keys, comments and line ends are read as the format has them") {
  const TemporaryFolder folder;
  const auto origin = [&](const std::string& bytes) { return read_bytes(folder, "a.nrrd", bytes).grid.origin; };
  const auto in_space = [&](const std::string& line) {
    return origin(nrrd(with_line(nrrd_lines(), "space: ", line), bytes_of_values(hu_counting())));
  };
  for (const char* lps : {"space: LPS", "space: left posterior superior", "space: scanner-xyz", "space dimension: 3",
                          "space: 3D-right-handed", "SPACE: Left-Posterior-Superior"})
    CHECK(in_space(lps) == glm::dvec3(10, 20, 30));
  CHECK(in_space("space: RAS") == glm::dvec3(-10, -20, 30));
  CHECK(in_space("space: left-anterior-superior") == glm::dvec3(-10, 20, 30));
  auto lines = nrrd_lines();
  lines.insert(lines.end(), {"space origin:=(9,9,9)", "# space origin: (8,8,8)", "axis mins: nan nan nan"});
  std::string bytes = nrrd(lines, "");
  CHECK(origin(bytes + bytes_of_values(hu_counting())) == glm::dvec3(10, 20, 30));
  for (std::size_t at = 0; (at = bytes.find('\n', at)) != std::string::npos; at += 2) bytes.replace(at, 1, "\r\n");
  CHECK(origin(bytes + bytes_of_values(hu_counting())) == glm::dvec3(10, 20, 30));
}

TEST_CASE("a MetaImage's synonyms, comments and line ends are read as the format has them") {
  const TemporaryFolder folder;
  const auto grid = [&](const std::vector<std::string>& lines) {
    return read_bytes(folder, "a.mha", meta_image(lines, bytes_of_values(hu_counting()))).grid;
  };
  const auto renamed = [](const std::string& name, const std::string& by) {
    auto lines = meta_lines();
    for (std::string& line : lines)
      if (line.starts_with(name + " ")) line.replace(0, name.size(), by);
    return lines;
  };
  const Grid usual = grid(with_line(meta_lines(), "TransformMatrix", "TransformMatrix = 0 1 0 -1 0 0 0 0 1"));
  CHECK(usual.direction == glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1));
  for (const char* name : {"Rotation", "Orientation"})
    CHECK(grid(with_line(meta_lines(), "TransformMatrix", name + std::string(" = 0 1 0 -1 0 0 0 0 1"))) == usual);
  for (const char* name : {"Position", "Origin"}) CHECK(grid(renamed("Offset", name)).origin == glm::dvec3(10, 20, 30));
  CHECK(grid(renamed("ElementSpacing", "ElementSize")).spacing == glm::dvec3(10, 20, 30));
  const Grid bare = grid(with_line(with_line(meta_lines(), "TransformMatrix", ""), "Offset", ""));
  CHECK(bare.direction == glm::dmat3(1.0));
  CHECK(bare.origin == glm::dvec3(0));
  std::string bytes = "Comment = by hand\n\n" + meta_image(meta_lines(), "");
  for (std::size_t at = 0; (at = bytes.find('\n', at)) != std::string::npos; at += 2) bytes.replace(at, 1, "\r\n");
  CHECK(read_bytes(folder, "b.mha", bytes + bytes_of_values(hu_counting())).voxels == hu_counting());
}

TEST_CASE("a written NRRD has the fields that other programs expect") {
  const TemporaryFolder folder;
  Grid grid{{4, 3, 2}, {10, 20, 0.1}, {10, -20.5, 30}, glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1)};
  const auto voxels = hu_counting();
  const std::string head =
      "NRRD0004\n# Complete NRRD file format specification at:\n# http://teem.sourceforge.net/nrrd/format.html\n"
      "type: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 4 3 2\n"
      "space directions: (0,10,0) (-20,0,0) (0,0,0.10000000000000001)\nkinds: domain domain domain\n"
      "endian: little\nencoding: ";
  write_nrrd(folder.path / "a.nrrd", grid, ElementType::int16, voxels.data());
  CHECK(read_file(folder.path / "a.nrrd") == head + "raw\nspace origin: (10,-20.5,30)\n\n" + bytes_of_values(voxels));
  const Volume<std::int16_t> again = read_case_ct(folder.path / "a.nrrd");
  CHECK(again.grid == grid);
  CHECK(again.voxels == voxels);
}

TEST_CASE("a file's axes are honoured, in each format's own convention") {
  const TemporaryFolder folder;
  const std::string voxels = bytes_of_values(hu_counting());
  // In LPS, axis i runs to the head, j to the right, k to the front; corner at (10, 20, 30).
  glm::dmat4 expected(0.0);
  expected[0] = glm::dvec4(0, 0, 10, 0);
  expected[1] = glm::dvec4(-20, 0, 0, 0);
  expected[2] = glm::dvec4(0, -30, 0, 0);
  expected[3] = glm::dvec4(10, 20, 30, 1);

  NiftiSpec spec;  // RAS: x and y change sign
  spec.sform = {0, 20, 0, -10, 0, 0, 30, -20, 10, 0, 0, 30};
  CHECK(most_apart(read_bytes(folder, "a.nii", nifti(spec, voxels)).grid.matrix(), expected) < 1e-5);

  auto lines = with_line(nrrd_lines(), "space directions", "space directions: (0,0,10) (-20,0,0) (0,-30,0)");
  CHECK(most_apart(read_bytes(folder, "a.nrrd", nrrd(lines, voxels)).grid.matrix(), expected) < 1e-9);
  lines = with_line(lines, "space: ", "space: right-anterior-superior");
  lines = with_line(lines, "space directions", "space directions: (0,0,10) (20,0,0) (0,30,0)");
  lines = with_line(lines, "space origin", "space origin: (-10,-20,30)");
  CHECK(most_apart(read_bytes(folder, "a.nrrd", nrrd(lines, voxels)).grid.matrix(), expected) < 1e-9);

  const auto meta = with_line(meta_lines(), "TransformMatrix", "TransformMatrix = 0 0 1 -1 0 0 0 -1 0");
  CHECK(most_apart(read_bytes(folder, "a.mha", meta_image(meta, voxels)).grid.matrix(), expected) < 1e-9);
}

TEST_CASE("every right-angled and any oblique orientation survives writing and reading") {
  const TemporaryFolder folder;
  Volume<std::int16_t> ct;
  ct.grid.size = {4, 3, 2};
  ct.grid.spacing = {5.5, 12.25, 30};
  ct.grid.origin = {-101.5, 7.25, 1000.125};
  ct.voxels = hu_counting();
  std::array<int, 3> order{0, 1, 2};
  int count = 0;
  do {
    for (int signs = 0; signs < 8; ++signs, ++count) {
      for (int a = 0; a < 3; ++a) {
        ct.grid.direction[a] = glm::dvec3(0);
        ct.grid.direction[a][order[std::size_t(a)]] = signs >> a & 1 ? -1 : 1;
      }
      write_ct(folder.path / "a.nrrd", ct);
      const Volume<std::int16_t> read = read_ct(folder.path / "a.nrrd");
      CHECK(most_apart(read.grid.matrix(), ct.grid.matrix()) < 1e-12);
      CHECK(read.voxels == ct.voxels);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  CHECK(count == 48);
  ct.grid.direction[0] = glm::normalize(glm::dvec3(1, 2, 3));
  ct.grid.direction[1] = glm::normalize(glm::cross(ct.grid.direction[0], glm::dvec3(0, 0, 1)));
  ct.grid.direction[2] = -glm::cross(ct.grid.direction[0], ct.grid.direction[1]);
  write_ct(folder.path / "a.nrrd", ct);
  CHECK(most_apart(read_ct(folder.path / "a.nrrd").grid.matrix(), ct.grid.matrix()) < 1e-9);
}

TEST_CASE("labels are whole numbers from 0 to 255 of any stored type") {
  const TemporaryFolder folder;
  const auto read = [&](const std::vector<float>& values) {
    folder.put("a.nrrd", nrrd(with_line(nrrd_lines(), "type", "type: float"), bytes_of_values(values)));
    return read_labels(folder.path / "a.nrrd");
  };
  std::vector<float> values(24, 0);
  values[5] = 255;
  CHECK(read(values).voxels[5] == 255);
  for (const float bad : {-1.0f, 256.0f, 0.5f, std::numeric_limits<float>::quiet_NaN()}) {
    values[5] = bad;
    CHECK_THROWS_WITH(read(values), Catch::Contains("voxel (1, 1, 0)") && Catch::Contains("not a whole number"));
  }
  Volume<std::uint8_t> labels{read(std::vector<float>(24, 3)).grid, counting<std::uint8_t>()};
  write_labels(folder.path / "b.nrrd", labels);
  CHECK(read_labels(folder.path / "b.nrrd").voxels == labels.voxels);
  CHECK_THROWS_AS(write_labels("/proc/none/b.nrrd", labels), InputError);
}

TEST_CASE("on real scans left is on the left, the back at the back and the head up") {
  const fs::path scans = fs::path(INSONATE_SCANS_FOLDER) / "abdomen_ct";
  if (!fs::exists(scans)) {
    WARN("skipped: the real scans are not at " << INSONATE_SCANS_FOLDER);
    return;
  }
  CtSource source;
  const Volume<std::int16_t> ct = read_ct(scans / "abdomen_ct.nii.gz", &source);
  CHECK(source.stored_as == "int32");
  CHECK(ct.grid.size == glm::ivec3(122, 101, 112));
  CHECK(ct.grid.spacing.x == Approx(3));
  // The file's affine is RAS: in LPS its first two axes turn round.
  CHECK(ct.grid.direction[0].x == Approx(-1));
  CHECK(ct.grid.direction[1].y == Approx(-1));
  CHECK(ct.grid.direction[2].z == Approx(1));

  // TotalSegmentator's label values, from the XML table in the file's header extension.
  const Volume<std::uint8_t> labels = read_labels(scans / "upper_labels.nii.gz");
  const auto centre_of = [&](int value) {
    glm::dvec3 sum(0);
    double count = 0;
    for (int k = 0; k < labels.grid.size.z; ++k)
      for (int j = 0; j < labels.grid.size.y; ++j)
        for (int i = 0; i < labels.grid.size.x; ++i)
          if (labels.at({i, j, k}) == value) {
            sum += labels.grid.patient_from_index({i, j, k});
            ++count;
          }
    REQUIRE(count > 0);
    return sum / count;
  };
  const glm::dvec3 spleen = centre_of(1), liver = centre_of(5), l2 = centre_of(30), t12 = centre_of(32);
  CHECK(liver.x < spleen.x - 50);  // +x is the patient's left, where the spleen is
  CHECK(l2.y > liver.y + 30);      // +y is the back, where the spine is
  CHECK(t12.z > l2.z + 30);        // +z is the head: the twelfth thoracic vertebra lies above the second lumbar
  const Volume<std::int16_t> upper = read_ct(scans / "upper_ct.nii.gz");
  CHECK(most_apart(upper.grid.matrix(), labels.grid.matrix()) < 1e-4);
}
