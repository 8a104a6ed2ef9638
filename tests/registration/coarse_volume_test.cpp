// Tests the volume that the widest stage of a registration searches in.

#include "sim/registration/coarse_volume.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cstddef>
#include <cstdint>

using namespace insonate;

namespace {

// A turned volume whose density is 100 times the first index, 10 times the second and once the third.
AcousticVolume slope(const glm::ivec3& size) {
  AcousticVolume volume;
  volume.grid.size = size;
  volume.grid.spacing = {0.7, 1.0, 3.0};
  volume.grid.origin = {5, -20, 40};
  volume.grid.direction = glm::dmat3(glm::rotate(glm::dmat4(1.0), 0.4, glm::normalize(glm::dvec3(1, 2, 3))));
  volume.voxels.resize(volume.grid.count());
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i) volume.at({i, j, k}).hu = std::int16_t(100 * i + 10 * j + k);
  return volume;
}

}  // namespace

TEST_CASE("a coarse volume has the mean density of whole blocks at their centres") {
  const AcousticVolume fine = slope({8, 6, 3}), coarse = coarse_volume(fine, 2);
  CHECK(coarse.grid.size == glm::ivec3(4, 3, 3));
  CHECK(glm::distance(coarse.grid.spacing, {1.4, 2.0, 3.0}) < 1e-12);
  CHECK(coarse.grid.direction == fine.grid.direction);
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i) {
        const glm::dvec3 in_fine(2 * i + 0.5, 2 * j + 0.5, k);
        CHECK(glm::distance(coarse.grid.patient_from_index(glm::dvec3(i, j, k)),
                            fine.grid.patient_from_index(in_fine)) < 1e-9);
        CHECK(coarse.at({i, j, k}).hu == int(100 * in_fine.x + 10 * in_fine.y + in_fine.z));
      }
}

TEST_CASE("a coarse volume's last blocks are the mean of the voxels that are there") {
  const AcousticVolume coarse = coarse_volume(slope({5, 3, 1}), 2);
  CHECK(coarse.grid.size == glm::ivec3(3, 2, 1));
  CHECK(coarse.at({2, 0, 0}).hu == 405);
  CHECK(coarse.at({2, 1, 0}).hu == 420);
}

TEST_CASE("a volume that is coarse already stays as it is") {
  const AcousticVolume fine = slope({4, 3, 2}), same = coarse_volume(fine, 0.5);
  CHECK(same.grid == fine.grid);
  for (std::size_t i = 0; i < fine.voxels.size(); ++i) CHECK(same.voxels[i].hu == fine.voxels[i].hu);
}
