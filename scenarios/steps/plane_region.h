#pragma once

#include <glm/vec2.hpp>

#include <optional>
#include <vector>

#include "scenarios/steps/structures.h"
#include "sim/core/pose.h"

namespace insonate {

/// The part of structures in a plane that hangs together and lies nearest to a point of it: its pixels, of `pitch_mm`
/// each, in the plane's mm.
struct PlaneRegion {
  double pitch_mm = 0;
  std::vector<glm::dvec2> pixels;  ///< middles

  double area_mm2() const { return double(pixels.size()) * pitch_mm * pitch_mm; }
  /// From the outermost edge to the outermost edge along a unit direction.
  double extent_mm(const glm::dvec2& along) const;
  /// The longest extent of all directions, to a thousandth.
  double longest_extent_mm() const;
  glm::dvec2 middle() const;  ///< of the pixels
};

/// Searches a window of the plane, `half_size_mm` to each side of the point. Without a point it is the middle of all
/// that the window holds around (0, half_size_mm). Empty when there is nothing.
std::optional<PlaneRegion> plane_region(const StructureSet& structures, const Pose& patient_from_plane,
                                        const std::optional<glm::dvec2>& near, double half_size_mm, double pitch_mm);

}  // namespace insonate
