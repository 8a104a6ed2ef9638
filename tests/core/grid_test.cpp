#include "sim/core/grid.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <limits>

using namespace insonate;

namespace {

// Reflected, permuted and anisotropic: whatever a reader ignores of the direction matrix shows.
Grid odd_grid() {
  Grid grid;
  grid.size = {5, 4, 3};
  grid.spacing = {0.5, 2.0, 7.0};
  grid.origin = {-10, 20, 30};
  grid.direction = glm::dmat3(glm::dvec3(0, -1, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1));
  return grid;
}

}  // namespace

TEST_CASE("index and patient position map to each other through any direction matrix") {
  const Grid grid = odd_grid();
  const glm::dvec3 index(1.25, 2.5, 0.75);
  const glm::dvec3 p = grid.patient_from_index(index);
  CHECK(p.x == Approx(-10 + 2.5 * 2.0));
  CHECK(p.y == Approx(20 - 1.25 * 0.5));
  CHECK(p.z == Approx(30 - 0.75 * 7.0));
  CHECK(glm::distance(grid.index_from_patient(p), index) < 1e-12);
  CHECK(glm::distance(glm::dvec3(grid.matrix() * glm::dvec4(index, 1)), p) < 1e-12);
}

TEST_CASE("trilinear sampling reproduces a linear field inside and runs into air outside") {
  Volume<std::int16_t> ct{odd_grid(), {}};
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 5; ++i) ct.voxels.push_back(std::int16_t(100 + 10 * i - 20 * j + 30 * k));
  CHECK(sample_trilinear(ct, {1.5, 2.25, 0.5}) == Approx(100 + 15 - 45 + 15));
  CHECK(sample_trilinear(ct, {0, 0, 0}) == Approx(100));
  CHECK(sample_trilinear(ct, {4, 3, 2}) == Approx(100 + 40 - 60 + 60));
  CHECK(sample_trilinear(ct, {-0.5, 0, 0}) == Approx((100 - 1000) / 2.0));
  CHECK(sample_trilinear(ct, {4.25, 3, 2}) == Approx(0.75 * 140 + 0.25 * -1000));
  CHECK(sample_trilinear(ct, {-1, 0, 0}) == Approx(-1000));
  CHECK(sample_trilinear(ct, {1e12, 0, 0}) == Approx(-1000));
  CHECK(sample_trilinear(ct, {std::numeric_limits<double>::quiet_NaN(), 0, 0}) == Approx(-1000));
}

TEST_CASE("the nearest label is taken inside, none outside") {
  Volume<std::uint8_t> labels{odd_grid(), std::vector<std::uint8_t>(60, 7)};
  labels.at({2, 1, 1}) = 9;
  CHECK(sample_nearest(labels, {2.4, 0.6, 1.4}) == 9);
  CHECK(sample_nearest(labels, {2.6, 0.6, 1.4}) == 7);
  CHECK(sample_nearest(labels, {-0.6, 0, 0}) == 0);
  CHECK(sample_nearest(labels, {1e300, 0, 0}) == 0);
}
