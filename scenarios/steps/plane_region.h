#pragma once

#include <glm/vec2.hpp>

#include <optional>
#include <vector>

#include "scenarios/steps/structures.h"
#include "sim/core/pose.h"

namespace insonate {

/// A connected part of structures in a plane: its pixels, each `pitch_mm` wide, in the plane's mm.
struct PlaneRegion {
  double pitch_mm = 0;
  std::vector<glm::dvec2> pixels;  ///< centres

  double area_mm2() const { return double(pixels.size()) * pitch_mm * pitch_mm; }
  /// Returns the distance between the outermost edges along a unit direction.
  double extent_mm(const glm::dvec2& along) const;
  /// Returns the longest extent over all directions, accurate to 0.1 %.
  double longest_extent_mm() const;
  glm::dvec2 middle() const;  ///< mean of the pixels' centres
};

/// Returns the connected part nearest to the point `near`, or nothing if the window holds none of the structures. The
/// window extends `half_size_mm` to each side of the point. Without a point, the search starts at the middle of all
/// pixels in the window around (0, half_size_mm).
std::optional<PlaneRegion> plane_region(const StructureSet& structures, const Pose& patient_from_plane,
                                        const std::optional<glm::dvec2>& near, double half_size_mm, double pitch_mm);

}  // namespace insonate
