#include "sim/volume/nifti_volume.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <functional>

#include "sim/core/input_error.h"
#include "sim/volume/ct_reader.h"
#include "tests/core/temporary_folder.h"
#include "tests/volume/volume_files.h"

using namespace insonate;

namespace {

/// An extension: its size with these 8 bytes, its code, its content.
std::string extension(std::int32_t size, const std::string& content) {
  return bytes_of_values<std::int32_t>({size, 4}) + content;
}

/// A NIfTI file with these bytes between the header's 352 and the voxels.
std::string with_extensions(const std::string& extensions) {
  NiftiSpec spec;
  spec.vox_offset = float(352 + extensions.size());
  std::string bytes = nifti(spec, extensions + std::string(48, '\0'));
  bytes[348] = 1;
  return bytes;
}

/// The same in the other order of bytes, as far as extensions go.
std::string swapped(std::string bytes, const std::vector<std::size_t>& numbers_at) {
  for (const std::size_t at : numbers_at)
    std::reverse(bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(at) + 4);
  return bytes;
}

/// Where a file places its voxels, in LPS; the same for NIfTI-1 and NIfTI-2.
Grid placed(const std::function<void(NiftiSpec&)>& change) {
  const TemporaryFolder folder;
  NiftiSpec spec;
  spec.sform_code = 0;
  spec.sform.fill(0);
  change(spec);
  const std::string voxels(48, '\1');
  const Grid grid = read_case_ct(folder.put("a.nii", nifti(spec, voxels))).grid;
  CHECK(read_case_ct(folder.put("b.nii", nifti_2(spec, voxels))).grid == grid);
  spec.big_endian = true;
  CHECK(read_case_ct(folder.put("c.nii", nifti(spec, voxels))).grid == grid);
  CHECK(read_case_ct(folder.put("d.nii", nifti_2(spec, voxels))).grid == grid);
  CHECK(grid.spacing == glm::dvec3(10, 20, 30));
  return grid;
}

// RAS, row by row: i runs to the left, j to the head, k to the back, from (1, 2, 3) on.
constexpr std::array<float, 12> kSform{-10, 0, 0, 1, 0, 0, -30, 2, 0, 20, 0, 3};

void check_placed(const Grid& grid, const glm::dvec3& origin, const glm::dmat3& direction) {
  CHECK(glm::distance(grid.origin, origin) < 1e-12);
  for (int a = 0; a < 3; ++a) CHECK(glm::distance(grid.direction[a], direction[a]) < 1e-6);
}

}  // namespace

TEST_CASE("a NIfTI file with neither qform nor sform begins at zero with the axes of LPS") {
  for (const float handedness : {1.0f, -1.0f, 0.0f})
    CHECK(placed([&](auto& s) { s.pixdim[0] = handedness, s.qoffset = {5, 6, 7}; }).direction == glm::dmat3(1.0));
  CHECK(placed([](auto& s) { s.sform = kSform, s.qoffset = {5, 6, 7}; }).origin == glm::dvec3(0));
}

TEST_CASE("a NIfTI file is placed by its qform, with a turn or half a turn and either handedness") {
  const auto by_qform = [](const std::array<float, 3>& quaternion, float handedness) {
    return placed([&](auto& s) {
      s.qform_code = 1;
      s.quaternion = quaternion;
      s.qoffset = {1, 2, 3};
      s.pixdim[0] = handedness;
    });
  };
  const glm::dvec3 origin(-1, -2, 3);
  check_placed(by_qform({0, 0, 0}, 1), origin, glm::dmat3(-1, 0, 0, 0, -1, 0, 0, 0, 1));
  check_placed(by_qform({0, 0, 0}, 0), origin, glm::dmat3(-1, 0, 0, 0, -1, 0, 0, 0, 1));
  check_placed(by_qform({0, 0, 0}, -1), origin, glm::dmat3(-1, 0, 0, 0, -1, 0, 0, 0, -1));
  // Half a turn about z: RAS becomes LPS.
  check_placed(by_qform({0, 0, 1}, 1), origin, glm::dmat3(1.0));
  // A third of a turn about (1, 1, 1): i runs along RAS y, j along z, k along x.
  check_placed(by_qform({0.5f, 0.5f, 0.5f}, 1), origin, glm::dmat3(0, -1, 0, 0, 0, 1, -1, 0, 0));
  check_placed(by_qform({0.5f, 0.5f, 0.5f}, -1), origin, glm::dmat3(0, -1, 0, 0, 0, 1, 1, 0, 0));
  // 2 acos(0.8) about x, oblique: cos 0.28, sin 0.96.
  check_placed(by_qform({0.6f, 0, 0}, 1), origin, glm::dmat3(-1, 0, 0, 0, -0.28, 0.96, 0, 0.96, 0.28));
  // Rounding may make a half turn's quaternion longer than 1.
  check_placed(by_qform({0.60006f, 0.80008f, 0}, 1), origin, glm::dmat3(0.28, -0.96, 0, -0.96, -0.28, 0, 0, 0, -1));
}

TEST_CASE("a NIfTI file's qform gives the axes of the format's own library to the last bit") {
  const Grid grid = placed([&](auto& s) { s.qform_code = 1, s.quaternion = {0.1f, 0.2f, 0.3f}; });
  CHECK(grid.direction == glm::dmat3(-0x1.7ae146936a970p-1, -0x1.315d968aae8aap-1, -0x1.3e684cf2a1a0dp-2,
                                     0x1.0867d3dcf67a2p-1, -0x1.999998c240a81p-1, 0x1.38cdc0833e0edp-2,
                                     -0x1.b94995293cfd9p-2, 0x1.0c2cbd00d02eep-4, 0x1.cccccc8c1f824p-1));
}

TEST_CASE("a NIfTI file with a qform and an sform is placed by the one that other programs choose") {
  const glm::dmat3 by_sform(1, 0, 0, 0, 0, 1, 0, 1, 0), by_qform(-1, 0, 0, 0, -1, 0, 0, 0, 1);
  const glm::dvec3 sform_origin(-1, -2, 3), qform_origin(-5, -6, 7);
  for (const std::int16_t code : {1, 2, 3, 4}) {
    INFO("sform code " << code);
    const auto with_sform = [&](auto& s) { s.sform_code = code, s.sform = kSform; };
    check_placed(placed(with_sform), sform_origin, by_sform);
    const auto with_both = [&](auto& s) { with_sform(s), s.qform_code = 1, s.qoffset = {5, 6, 7}; };
    const Grid both = placed(with_both);
    if (code == 1)
      check_placed(both, sform_origin, by_sform);
    else
      check_placed(both, qform_origin, by_qform);
    // An sform that shears or stretches gives way to the qform.
    check_placed(placed([&](auto& s) { with_both(s), s.sform[1] = 0.01f; }), qform_origin, by_qform);
    check_placed(placed([&](auto& s) { with_both(s), s.sform[0] = -10.01f; }), qform_origin, by_qform);
  }
  // A rotation of the scanner's frame by 1e-4 is within rounding.
  const Grid turned =
      placed([&](auto& s) { s.sform_code = 1, s.sform = kSform, s.sform[9] = 20, s.sform[5] = 0.001f; });
  check_placed(turned, sform_origin, glm::dmat3(1, 0, 0, 0, -5e-5, 1, 0, 1, 5e-5));
}

TEST_CASE("a NIfTI file far from zero is placed by its sform alone") {
  // A matrix in single precision with such an offset has no usable inverse, and needs none.
  const Grid grid = placed([](auto& s) {
    s.sform_code = 1;
    s.sform = kSform;
    s.sform[3] = 499.7f, s.sform[7] = -312.4f, s.sform[11] = -1433.9f;
  });
  CHECK(glm::distance(grid.origin, glm::dvec3(-499.7, 312.4, -1433.9)) < 1e-4);
}

TEST_CASE("the extensions of a NIfTI header are read in either order of bytes, packed or not") {
  const TemporaryFolder folder;
  const std::string two = extension(16, "liver = ") + extension(32, "a longer note, of 24 b..");
  const std::string plain = with_extensions(two);
  for (const std::string& bytes : {plain, gzip(plain), swapped(plain, {0, 108, 352, 368})}) {
    const auto found = read_nifti_extensions(folder.put("a.nii", bytes));
    REQUIRE(found.size() == 2);
    CHECK(found[0] == "liver = ");
    CHECK(found[1] == "a longer note, of 24 b..");
  }
  std::string second = nifti_2({}, two + std::string(48, '\0'));
  second[540] = 1;
  const std::int64_t voxels_at = 544 + 48;
  std::memcpy(second.data() + 168, &voxels_at, sizeof voxels_at);
  CHECK(read_nifti_extensions(folder.put("a.nii", second)).size() == 2);
  CHECK(read_nifti_extensions(folder.put("a.nii", nifti({}, std::string(48, '\0')))).empty());
  CHECK(read_nifti_extensions(folder.put("a.nii", "short")).empty());
  CHECK(read_nifti_extensions(folder.put("a.nii", std::string(400, 'x'))).empty());
}

TEST_CASE("a NIfTI extension that cannot be is refused with the reason") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& bytes, const std::string& sentence) {
    const auto file = folder.put("a.nii", bytes);
    CHECK_THROWS_WITH(read_nifti_extensions(file),
                      Catch::Equals(file.string() + ": header extension: " + sentence + "; write the file again."));
  };
  const std::string one = extension(16, "liver = ");
  refused(with_extensions(extension(0, "liver = ")), "it claims 0 bytes");
  refused(with_extensions(extension(17, "liver = ")), "it claims 17 bytes");
  refused(with_extensions(extension(32, "liver = ")), "it claims 32 bytes");
  refused(with_extensions(one).substr(0, 352 + 4), "the file ends within it");
  refused(with_extensions(one).substr(0, 352 + 12), "the file ends within it");
  std::string far = with_extensions(one);
  const float beyond = float(17 << 20);
  std::memcpy(far.data() + 108, &beyond, sizeof beyond);
  refused(far, "the header claims that the voxels begin beyond 16 MiB");
  CHECK_THROWS_WITH(read_nifti_extensions(folder.path / "none.nii"),
                    Catch::Contains("none.nii: header: it cannot be read; check"));
}
