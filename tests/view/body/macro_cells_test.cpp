#include "sim/view/body/macro_cells.h"

#include <catch2/catch.hpp>
#include <glm/common.hpp>

#include <cmath>
#include <cstdlib>
#include <random>

#include "sim/view/body/distance_map.h"

using namespace insonate;
using namespace insonate::view;

TEST_CASE("the distance map has the largest of the steps to the nearest busy cell") {
  std::mt19937 random(3);
  for (const glm::ivec3 size : {glm::ivec3(1), glm::ivec3(9, 7, 5), glm::ivec3(40, 3, 2), glm::ivec3(2, 3, 40)})
    for (const unsigned rarity : {3u, 20u, 1000000u}) {
      const std::size_t count = std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
      std::vector<std::uint8_t> busy(count);
      for (std::uint8_t& cell : busy) cell = random() % rarity == 0;
      const std::vector<std::uint8_t> distance = distance_map(size, busy);
      std::size_t cell = 0;
      for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
          for (int x = 0; x < size.x; ++x, ++cell) {
            int least = kMaxDistance;
            std::size_t other = 0;
            for (int k = 0; k < size.z; ++k)
              for (int j = 0; j < size.y; ++j)
                for (int i = 0; i < size.x; ++i, ++other)
                  if (busy[other])
                    least = std::min(least, std::max({std::abs(x - i), std::abs(y - j), std::abs(z - k)}));
            REQUIRE(int(distance[cell]) == least);
          }
    }
}

TEST_CASE("no sample in an empty cell is visible, and no cell with a visible voxel is empty") {
  std::mt19937 random(4);
  Volume<std::int16_t> ct;
  ct.grid.size = {19, 11, 23};
  // Blobs of equal values, so that some cells are empty for a function that shows a part of the range.
  for (std::size_t i = 0; i < ct.grid.count(); ++i)
    ct.voxels.push_back(std::int16_t(random() % 40 + 700 * ((i / 6) % 19 / 7) - 900));
  const MacroCells cells(ct);
  std::size_t empty_cells = 0;
  for (const double from : {-950.0, -870.0, -300.0, -200.0, 460.0, 530.0, 2000.0}) {
    const TransferTable table({"", {{from, {}, 0}, {from + 1, {}, 0.5}, {from + 30, {}, 0.5}, {from + 31, {}, 0}}});
    const std::vector<std::uint8_t> occupied = cells.occupied(VisibleRanges(table));
    REQUIRE(occupied.size() == std::size_t(cells.size().x) * std::size_t(cells.size().y) * std::size_t(cells.size().z));
    std::size_t cell = 0;
    for (int z = 0; z < cells.size().z; ++z)
      for (int y = 0; y < cells.size().y; ++y)
        for (int x = 0; x < cells.size().x; ++x, ++cell) {
          empty_cells += !occupied[cell];
          const glm::dvec3 first = glm::dvec3(x, y, z) * double(MacroCells::kSide);
          bool visible = false;
          for (int sample = 0; sample < 300; ++sample) {
            std::uniform_real_distribution<double> within(0, MacroCells::kSide);
            const glm::dvec3 at = first + glm::dvec3(within(random), within(random), within(random));
            if (glm::any(glm::greaterThan(at, glm::dvec3(ct.grid.size)))) continue;
            visible = visible || table.value(sample_trilinear(ct, at - 0.5)).a > 0;  // edges to middles of voxels
          }
          if (visible) REQUIRE(occupied[cell]);
          const glm::ivec3 low = glm::ivec3(first), high = glm::min(low + MacroCells::kSide, ct.grid.size);
          for (int k = low.z; k < high.z; ++k)
            for (int j = low.y; j < high.y; ++j)
              for (int i = low.x; i < high.x; ++i)
                if (table.value(ct.at({i, j, k})).a > 0) REQUIRE(occupied[cell]);
        }
  }
  CHECK(empty_cells > 20);
}

TEST_CASE("a hidden cell is empty whatever the function shows") {
  Volume<std::int16_t> ct;
  ct.grid.size = glm::ivec3(2 * MacroCells::kSide, MacroCells::kSide, MacroCells::kSide);
  ct.voxels.assign(ct.grid.count(), 40);
  MacroCells cells(ct);
  cells.hide({0, 1});
  const TransferTable all({"", {{-1024, {}, 0.5}, {3071, {}, 0.5}}});
  CHECK(cells.occupied(VisibleRanges(all)) == std::vector<std::uint8_t>{1, 0});
}
