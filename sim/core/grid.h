#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace insonate {

/// Places the voxels of a volume in the patient (LPS, mm). Voxel centres have integer indices.
struct Grid {
  glm::ivec3 size{0};         ///< voxels along i, j, k; i runs fastest in memory
  glm::dvec3 spacing{1.0};    ///< mm between centres along i, j, k; > 0, may differ
  glm::dvec3 origin{0.0};     ///< patient position of the centre of voxel (0, 0, 0), mm
  glm::dmat3 direction{1.0};  ///< column c is the patient direction of axis c; any rotation or reflection

  bool operator==(const Grid&) const = default;

  std::size_t count() const { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); }
  std::size_t offset(const glm::ivec3& i) const {
    return (std::size_t(i.z) * std::size_t(size.y) + std::size_t(i.y)) * std::size_t(size.x) + std::size_t(i.x);
  }
  bool contains(const glm::ivec3& i) const {
    return i.x >= 0 && i.y >= 0 && i.z >= 0 && i.x < size.x && i.y < size.y && i.z < size.z;
  }

  glm::dvec3 patient_from_index(const glm::dvec3& index) const { return origin + direction * (spacing * index); }
  glm::dvec3 index_from_patient(const glm::dvec3& p) const;

  /// Returns the affine map from continuous index to patient mm.
  glm::dmat4 matrix() const;

  /// Returns the centre of the volume's box, patient mm.
  glm::dvec3 centre() const { return patient_from_index((glm::dvec3(size) - 1.0) / 2.0); }
};

/// Holds one value per voxel of a grid.
template <typename T>
struct Volume {
  Grid grid;
  std::vector<T> voxels;  ///< grid.count() values, i fastest; empty if there is no volume

  bool empty() const { return voxels.empty(); }
  const T& at(const glm::ivec3& i) const { return voxels[grid.offset(i)]; }
  T& at(const glm::ivec3& i) { return voxels[grid.offset(i)]; }
};

/// Returns the largest whole number not above x, which must fit an int. std::floor is a library call, whose cost is
/// noticeable when millions of voxels are sampled.
inline int floor_of(double x) {
  const int cut = int(x);
  return cut - (x < cut);
}

/// The Hounsfield units assumed outside every CT.
inline constexpr double kAir_hu = -1000.0;

/// Returns the Hounsfield units at a continuous index: trilinear between centres, air outside. Within one voxel of the
/// border the value falls linearly to air, as with the GPU's clamp-to-border sampling.
double sample_trilinear(const Volume<std::int16_t>& ct, const glm::dvec3& index);

/// Returns the label of the nearest voxel, 0 outside the volume.
std::uint8_t sample_nearest(const Volume<std::uint8_t>& labels, const glm::dvec3& index);

}  // namespace insonate
