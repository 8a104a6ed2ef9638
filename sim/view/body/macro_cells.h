#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

#include "sim/core/grid.h"
#include "sim/view/body/transfer_function.h"

namespace insonate::view {

/// Cubes of a CT's voxels with the range of their Hounsfield units. They show which parts a transfer function leaves
/// empty, whatever the function.
///
/// The paper uses an octree for this. A grid of cells needs no tree: with a distance per cell, a ray leaps over any
/// empty region in one or two steps. Cells of 4 voxels need 18 % less time per picture than cells of 8 (llvmpipe). For
/// a CT of 512 x 512 x 484 voxels their ranges take 8 MiB, and the distances for a new function 10 to 15 ms on 2 cores;
/// a graphics card measures them by itself. So each edit gets exact distances at once, without the maps per part of the
/// range that Rauter, Zimmermann, Zeilinger (2024) combine.
class MacroCells {
public:
  static constexpr int kSide = 4;  ///< voxels per side

  MacroCells() = default;
  /// Uses all cores.
  explicit MacroCells(const Volume<std::int16_t>& ct);

  /// Cells along each axis.
  const glm::ivec3& size() const { return size_; }

  /// Forces the cells for which `hidden` is not 0 to be empty, whatever the function.
  void hide(const std::vector<std::uint8_t>& hidden);

  /// Returns 1 for each cell in which a trilinear sample of the CT can be visible, else 0. The samples are those from
  /// the cell's first face to its last; the CT is surrounded by air.
  std::vector<std::uint8_t> occupied(const VisibleRanges& visible) const;

private:
  glm::ivec3 size_{0};
  std::vector<std::array<std::int16_t, 2>> ranges_;  ///< the least and the greatest HU per cell
};

}  // namespace insonate::view
