#include "sim/volume/ct_reader.h"

#include <catch2/catch.hpp>

#include "tests/volume/temporary_folder.h"

using namespace insonate;
namespace fs = std::filesystem;

TEST_CASE("the real CT is read with its size, spacing and orientation") {
  const fs::path file = fs::path(INSONATE_SCANS_FOLDER) / "abdomen_ct" / "abdomen_ct.nii.gz";
  if (!fs::exists(file)) {
    WARN("skipped: the real scans are not at " << INSONATE_SCANS_FOLDER);
    return;
  }
  CtSource source;
  const Volume<std::int16_t> ct = read_ct(file, &source);
  CHECK(source.format == "NIfTI");
  CHECK(source.stored_as == "int32");
  CHECK(ct.grid.size == glm::ivec3(122, 101, 112));
  CHECK(ct.grid.spacing.x == Approx(3));
  // The file's affine is diag(3, 3, 3) in RAS: in LPS the first two axes turn round.
  CHECK(ct.grid.direction[0].x == Approx(-1));
  CHECK(ct.grid.direction[1].y == Approx(-1));
  CHECK(ct.grid.direction[2].z == Approx(1));
}
