#include "sim/tissue/skin_contact.h"

#include <catch2/catch.hpp>

#include "sim/tissue/coupling.h"

using namespace insonate;

namespace {

constexpr double kSkin_mm = 10;  // along y, between two voxels

/// A body below kSkin_mm along y, as far as `edge_mm` along x; air elsewhere. Voxels of 1 mm, from -40 to 40 mm.
Volume<std::int16_t> body_until(double edge_mm) {
  Volume<std::int16_t> ct;
  ct.grid.size = glm::ivec3(81);
  ct.grid.origin = glm::dvec3(-40);
  ct.voxels.assign(ct.grid.count(), -1000);
  for (int k = 0; k < 81; ++k)
    for (int j = 0; j < 81; ++j)
      for (int i = 0; i < 81; ++i) {
        const glm::dvec3 at = ct.grid.patient_from_index(glm::dvec3(i, j, k));
        if (at.x < edge_mm && at.y > kSkin_mm) ct.at({i, j, k}) = 0;
      }
  return ct;
}

}  // namespace

TEST_CASE("the skin is found where the density is half that of air, from outside and from within") {
  const Volume<std::int16_t> ct = body_until(1000);
  const double skin_mm = kSkin_mm + 0.5;  // half way from the last voxel of air to the first of water
  CHECK(distance_to_skin(ct, {0, -5, 0}, {0, 1, 0}, 30).value() == Approx(skin_mm + 5).margin(0.01));
  CHECK_FALSE(distance_to_skin(ct, {0, -5, 0}, {0, 1, 0}, 15));
  CHECK_FALSE(distance_to_skin(ct, {0, -5, 0}, {0, -1, 0}, 30));
  CHECK(distance_to_skin(ct, {0, 20, 0}, {0, 1, 0}, 30) == 0.0);
  CHECK(distance_out_of_body(ct, {0, 20, 0}, {0, -1, 0}, 30).value() == Approx(20 - skin_mm).margin(0.01));
  CHECK(distance_out_of_body(ct, {0, -5, 0}, {0, 1, 0}, 30) == 0.0);
}

TEST_CASE("a face is on the skin if three of its five places are, within the thickness of the gel") {
  const Probe& probe = *find_probe("linear");
  const auto on_skin = [&](double edge_mm, double y_mm) {
    const Volume<std::int16_t> ct = body_until(edge_mm);
    return SkinContact(ct, probe).at({glm::dmat3(1.0), {0, y_mm, 0}});
  };
  // The places lie at -0.4, -0.2, 0, 0.2 and 0.4 of the face's width.
  CHECK(on_skin(0.1 * probe.width_mm, kSkin_mm));
  CHECK_FALSE(on_skin(-0.1 * probe.width_mm, kSkin_mm));
  CHECK(on_skin(1000, kSkin_mm + 8));  // pressed in
  CHECK(on_skin(1000, kSkin_mm - kUsualGel_mm + 1));
  CHECK_FALSE(on_skin(1000, kSkin_mm - kUsualGel_mm - 1));
}
