#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/phantom/shapes.h"
#include "sim/phantom/texture.h"

namespace insonate {

/// Thin sheets of another density within a tissue: the perimysium between bundles of muscle fibres, or the septa
/// between lobules of fat. They follow a field of directions: parallel to a surface, or along the centre line of a
/// tube.
struct SeptaForm {
  float hu = -40;         ///< added to the density in a sheet's middle
  float apart_mm = 3;     ///< mean distance across the field
  float along_mm = 30;    ///< length along the field before a sheet ends or bends
  float thick_mm = 1;     ///< thickness at half of `hu`; below the voxel's size they break up
  ShapePtr layers_of;     ///< sheets are parallel to its surface
  Strand along;           ///< without layers_of: sheets are parallel to this line
  bool mirrored = false;  ///< the line also counts mirrored at x = 0, for the other side
  std::uint32_t seed = 0;
};

/// The density that septa add.
///
/// A septum lies where a smooth noise n with unit deviation passes through zero. The noise is a function of the place
/// in the field: for layers d / apart_mm, d being the distance to the surface, and p / along_mm; for a line the offset
/// from its nearest point / apart_mm, and the way along it / along_mm. It adds hu max(0, 1 - |n| / w), w being the
/// share of a sheet's thickness in their distance.
class Septa {
public:
  explicit Septa(const SeptaForm& form);

  /// Returns the added Hounsfield units at the points with the indices `which`, in that order.
  std::vector<float> at(Points& points, const std::vector<std::size_t>& which) const;

private:
  SeptaForm form_;
  Texture noise_;
  std::vector<float> way_;  // along the line up to each of its points, mm
};

}  // namespace insonate
