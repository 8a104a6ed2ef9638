// The patient among what lies around.

#include "scenarios/cases/body.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "scenarios/cases/import_case.h"
#include "sim/tissue/tissue.h"
#include "sim/volume/ct_reader.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;

namespace {

// A trunk of 60 mm radius along z on a table of 4 mm that touches it, a lung in it that the first slice cuts, an arm
// beside it and a shirt of 2 mm over it; 2 mm voxels.
constexpr double kTrunk_mm = 60;

enum Part { nothing, trunk, lung, table, arm, shirt };

Part part_at(const glm::dvec3& p) {
  const double r = std::hypot(p.x, p.y);
  if (std::hypot(p.x + 20, p.y) <= 20 && p.z < 0) return lung;
  if (r <= kTrunk_mm) return trunk;
  if (p.y > 60 && p.y < 64) return table;
  if (std::hypot(p.x - 80, p.y) <= 12) return arm;
  return p.y < 0 && r > 70 && r < 72 ? shirt : nothing;
}

Volume<std::int16_t> scan() {
  Volume<std::int16_t> ct;
  ct.grid.size = {101, 81, 30};
  ct.grid.spacing = glm::dvec3(2.0);
  ct.grid.origin = {-100, -80, -29};
  ct.voxels.resize(ct.grid.count());
  for (int k = 0; k < ct.grid.size.z; ++k)
    for (int j = 0; j < ct.grid.size.y; ++j)
      for (int i = 0; i < ct.grid.size.x; ++i) {
        const Part part = part_at(ct.grid.patient_from_index({i, j, k}));
        ct.at({i, j, k}) = std::int16_t(part == nothing ? -1000 : part == lung ? -850 : 40);
      }
  return ct;
}

}  // namespace

TEST_CASE("the body is the trunk with its lungs, without table, arm and shirt") {
  const Volume<std::int16_t> ct = scan();
  const BodyMask body = find_body(ct);
  REQUIRE_FALSE(body.empty());
  std::size_t wrong = 0, rim = 0;
  for (int k = 0; k < ct.grid.size.z; ++k)
    for (int j = 0; j < ct.grid.size.y; ++j)
      for (int i = 0; i < ct.grid.size.x; ++i) {
        const glm::dvec3 p = ct.grid.patient_from_index({i, j, k});
        const Part part = part_at(p);
        const bool should = part == trunk || part == lung;
        if (bool(body.at({i, j, k})) == should) continue;
        // Where table and trunk touch, and within what growing back adds, a voxel may be either's.
        if (part == table && std::abs(p.x) < 40)
          ++rim;
        else
          ++wrong;
      }
  CHECK(wrong == 0);
  // 3 voxels grown back beside the line of contact, in both of the table's layers, and the slit beside it.
  CHECK(rim <= std::size_t(30 * 2 * 20));

  Volume<std::int16_t> cleared = ct;
  const std::size_t voxels = clear_around(body, cleared);
  std::size_t left = 0, gone = 0;
  for (std::size_t v = 0; v < ct.voxels.size(); ++v) {
    if (body.voxels[v]) CHECK(cleared.voxels[v] == ct.voxels[v]);
    left += !body.voxels[v] && cleared.voxels[v] > -500;
    gone += ct.voxels[v] > -500 && cleared.voxels[v] <= -500;
  }
  CHECK(gone == voxels);
  // The arm's and the shirt's voxels at least: pi 12^2 / 4 a slice of 30, and a half ring.
  CHECK(voxels > 30 * 150);
  // What stays is the table's within two voxels of the trunk.
  CHECK(left < std::size_t(30 * 2 * 30));
}

TEST_CASE("a CT without a body has none") {
  Volume<std::int16_t> ct = scan();
  std::fill(ct.voxels.begin(), ct.voxels.end(), std::int16_t(-1000));
  CHECK(find_body(ct).empty());
  for (int k = 0; k < 30; ++k) ct.at({50, 40, k}) = 1000;  // a wire
  CHECK(find_body(ct).empty());
}

TEST_CASE("a CT in which nothing is as thick as a body is refused by its name") {
  const TemporaryFolder folder;
  Volume<std::int16_t> sheet;
  sheet.grid.size = glm::ivec3(30);
  sheet.voxels.assign(sheet.grid.count(), -1000);
  Volume<std::uint8_t> mask{sheet.grid, std::vector<std::uint8_t>(sheet.grid.count())};
  for (int k = 0; k < 30; ++k)
    for (int i = 0; i < 30; ++i) {
      sheet.at({i, 14, k}) = 40;
      mask.at({i, 14, k}) = 1;
    }
  write_ct(folder.path / "ct.nrrd", sheet);
  std::filesystem::create_directory(folder.path / "masks");
  write_labels(folder.path / "masks" / "thing.nrrd", mask);
  ImportRequest request;
  request.ct = folder.path / "ct.nrrd";
  request.labels = folder.path / "masks";
  CHECK_THROWS_WITH(import_case(request, TissueTable{}),
                    Catch::Contains("ct.nrrd: there is no body in it: nothing denser than -500 HU is thicker than "
                                    "7 mm; give a CT in Hounsfield units"));
}
