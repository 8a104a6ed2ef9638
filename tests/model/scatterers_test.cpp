#include "sim/model/scatterers.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/core/hash.h"

using namespace insonate;

TEST_CASE("the scatterers of a seed are the same numbers everywhere") {
  static_assert(hash(0) == 0 && hash(1) == 0x514e28b7);  // MurmurHash3's own
  // Computed by the formula of scatterers.h in another language.
  const auto drawn = [](std::uint32_t seed) {
    const ScattererLattice lattice = make_scatterers(seed);
    REQUIRE(lattice.stored.size() == 2 * 128 * 128 * 128);
    return std::vector<std::int16_t>{lattice.stored[0], lattice.stored[1], lattice.stored[2], lattice.stored[3],
                                     lattice.stored.back()};
  };
  CHECK(drawn(1) == std::vector<std::int16_t>{-6934, 8009, -2933, -7061, -9353});
  CHECK(drawn(7) == std::vector<std::int16_t>{-676, -4259, -5827, 12976, -9102});
}

TEST_CASE("the lattice is rotated right-handed about its axis, and repeats after its cells") {
  const double cell_mm = 0.65, period_mm = cell_mm * ScattererLattice::kSide;
  const glm::dmat4 map = lattice_from_patient(cell_mm);
  const auto turned = [&](const glm::dvec3& p) { return period_mm * glm::dvec3(map * glm::dvec4(p, 1)); };
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 0.7, 0.4));
  CHECK(glm::distance(turned(axis), axis) < 1e-12);
  const glm::dvec3 across = glm::normalize(glm::cross(axis, glm::dvec3(0, 0, 1)));
  CHECK(glm::distance(turned(across), std::cos(0.6) * across + std::sin(0.6) * glm::cross(axis, across)) < 1e-12);
  CHECK(glm::length(turned({0, 0, 0})) < 1e-12);
}
