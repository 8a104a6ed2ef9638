#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <vector>

#include "sim/core/grid.h"
#include "sim/core/image.h"
#include "sim/core/pose.h"

namespace insonate {

/// The box around a volume along the axes of its planes.
struct PlaneBox {
  glm::dmat3 axes;       ///< columns: the planes' rows, the beam in the middle, and across the planes
  glm::dvec3 low, high;  ///< along them, mm
};

/// The planes in which a swept volume was acquired: tilted about a line across the beam, as a 3D probe or a tilting
/// hand leaves them, or parallel.
struct SweptPlanes {
  double first = 0, last = 0;  ///< between the outermost planes: angles from the beam, rad; where parallel, mm across
  bool tilted = false;
  double axis_y = 0, axis_z = 0;  ///< where tilted: the line about which they are tilted, mm along the beam and across

  /// Returns a plane, 0 the first and 1 the last: x along the rows and y along the beam, both 0 where the box has 0;
  /// where tilted, y is 0 on the line.
  Pose plane(const PlaneBox& box, double share) const;
  /// Returns the range of y in which planes meet the box.
  glm::dvec2 depths(const PlaneBox& box) const;
};

/// Finds how the planes lie from the voxels that are known. Seen along the rows, tilted planes fill a wedge, whose two
/// straight sides are the outermost planes; they are fitted from near the top down to where the wedge is widest. Planes
/// are parallel where the sides open by less than 3 degrees, are not straight to a voxel, as those of planes that
/// cross, or are shorter than a third of the wedge.
/// @param known  whether a voxel is known, by its index
SweptPlanes find_swept_planes(const Grid& grid, const PlaneBox& box,
                              const std::function<bool(const glm::ivec3&)>& known);

/// Returns which places of the planes are known in a tenth of them, as find_fan() takes it: columns along the rows from
/// box.low.x on, rows along the beam from depths().x on.
/// @param mm  side of a pixel
Image<std::uint8_t> known_in_planes(const Grid& grid, const PlaneBox& box, const SweptPlanes& planes, double mm,
                                    const std::function<bool(const glm::ivec3&)>& known);

}  // namespace insonate
