#include "sim/volume/nifti_extensions.h"

#include <catch2/catch.hpp>

#include <algorithm>

#include "sim/core/input_error.h"
#include "tests/volume/temporary_folder.h"
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

}  // namespace

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
  CHECK(read_nifti_extensions(folder.put("a.nii", nifti({}, std::string(48, '\0')))).empty());
  CHECK(read_nifti_extensions(folder.put("a.nii", "short")).empty());
  CHECK(read_nifti_extensions(folder.put("a.nii", std::string(400, 'x'))).empty());
}

TEST_CASE("a NIfTI extension that cannot be is refused with the reason") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& bytes, const std::string& told) {
    const auto file = folder.put("a.nii", bytes);
    CHECK_THROWS_WITH(read_nifti_extensions(file),
                      Catch::Equals(file.string() + ": header extension: " + told + "; write the file again."));
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
                    Catch::Contains("none.nii: it cannot be read; check"));
}
