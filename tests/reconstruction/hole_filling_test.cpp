#include "sim/reconstruction/hole_filling.h"

#include <catch2/catch.hpp>

using namespace insonate;

namespace {

ReconstructedVolume empty_volume(const glm::ivec3& size, double spacing_mm = 1) {
  ReconstructedVolume volume;
  volume.grey.grid.size = size;
  volume.grey.grid.spacing = glm::dvec3(spacing_mm);
  volume.known.grid = volume.grey.grid;
  volume.grey.voxels.resize(volume.grey.grid.count());
  volume.known.voxels.resize(volume.grey.grid.count());
  return volume;
}

void measure(ReconstructedVolume& volume, const glm::ivec3& voxel, int grey) {
  volume.grey.at(voxel) = std::uint8_t(grey);
  volume.known.at(voxel) = std::uint8_t(VoxelKnown::measured);
}

int known_at(const ReconstructedVolume& volume, const glm::ivec3& voxel) {
  return volume.known.at(voxel);
}

}  // namespace

TEST_CASE("between two measured voxels the values are interpolated") {
  ReconstructedVolume volume = empty_volume({9, 3, 3});
  measure(volume, {1, 1, 1}, 40);
  measure(volume, {5, 1, 1}, 80);
  fill_holes(volume, 2);
  for (int i = 2; i < 5; ++i) {
    CHECK(known_at(volume, {i, 1, 1}) == 1);
    CHECK(int(volume.grey.at({i, 1, 1})) == 40 + 10 * (i - 1));
  }
  CHECK(known_at(volume, {1, 1, 1}) == 2);
  CHECK(int(volume.grey.at({1, 1, 1})) == 40);
  // Neither beyond them nor beside the line between them.
  CHECK(std::count(volume.known.voxels.begin(), volume.known.voxels.end(), 1) == 3);
}

TEST_CASE("holes up to twice the radius are filled, and larger ones are not") {
  for (const double spacing_mm : {0.4, 1.0}) {
    ReconstructedVolume volume = empty_volume({4, 4, 20}, spacing_mm);
    measure(volume, {2, 2, 3}, 10);
    measure(volume, {2, 2, 9}, 10);
    ReconstructedVolume other = volume;
    fill_holes(volume, 3 * spacing_mm);
    CHECK(known_at(volume, {2, 2, 4}) == 1);
    CHECK(known_at(volume, {2, 2, 8}) == 1);
    fill_holes(other, 2.9 * spacing_mm);
    CHECK(std::count(other.known.voxels.begin(), other.known.voxels.end(), 1) == 0);
  }
}

TEST_CASE("a radius of 0 fills nothing") {
  ReconstructedVolume volume = empty_volume({6, 6, 6});
  measure(volume, {1, 1, 1}, 9);
  measure(volume, {3, 1, 1}, 9);
  fill_holes(volume, 0);
  CHECK(std::count(volume.known.voxels.begin(), volume.known.voxels.end(), 1) == 0);
}

TEST_CASE("holes are filled along diagonals, with the nearer voxels counting more") {
  ReconstructedVolume volume = empty_volume({7, 7, 7});
  measure(volume, {2, 2, 3}, 10);
  measure(volume, {4, 4, 3}, 10);
  measure(volume, {3, 3, 1}, 100);
  measure(volume, {3, 3, 5}, 100);
  fill_holes(volume, 2);
  CHECK(known_at(volume, {3, 3, 3}) == 1);
  // 1 / 8 for the diagonal of length sqrt(8), 1 / 16 for the other.
  CHECK(int(volume.grey.at({3, 3, 3})) == std::lround((10 / 8.0 + 100 / 16.0) / (1 / 8.0 + 1 / 16.0)));
}

TEST_CASE("filled voxels do not fill others, at the borders of a volume neither") {
  ReconstructedVolume volume = empty_volume({40, 5, 5});
  for (const int i : {0, 3, 20, 23, 39}) measure(volume, {i, 2, 2}, i);
  fill_holes(volume, 1.5);
  for (int i = 0; i < 40; ++i) {
    const bool between = (i > 0 && i < 3) || (i > 20 && i < 23);
    const bool measured = i == 0 || i == 3 || i == 20 || i == 23 || i == 39;
    CHECK(known_at(volume, {i, 2, 2}) == (measured ? 2 : between ? 1 : 0));
  }
}
