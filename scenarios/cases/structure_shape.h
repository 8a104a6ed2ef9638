#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/volume/case.h"

namespace insonate {

/// Returns the axis or its opposite, whichever points to the head, the patient's right or the front. The axis' largest
/// component decides which of these three applies. Probe markers are held on this side, and structures' axes are named
/// by it.
glm::dvec3 marker_side(const glm::dvec3& axis);

/// Returns the direction of an axis as a word for names: "upper", "lower", "right", "left", "front" or "back".
std::string end_of_axis(const glm::dvec3& axis);

/// The shape of a labelled structure as a solid of box-shaped voxels. Patient, mm.
///
/// The axes are the principal axes of its voxels, each oriented by marker_side().
struct StructureShape {
  Label label;
  std::size_t voxels = 0;
  glm::ivec3 low{0}, high{0};    ///< inclusive bounding box of its voxels
  glm::dvec3 centroid{0.0};      ///< mean of all its voxels; may lie outside the structure
  glm::dvec3 centre{0.0};        ///< the centroid, or the nearest voxel if the centroid lies outside
  glm::dmat3 axes{1.0};          ///< unit columns, the longest first
  glm::dvec3 deviation_mm{0.0};  ///< standard deviation of its volume along each axis, falling
  glm::dvec3 first_pole{0.0};    ///< centre of the outermost 5 % of its length at the tip of the long axis
  glm::dvec3 second_pole{0.0};   ///< the same at the other end
  bool cut = false;              ///< it touches the CT's first or last slice along some axis: part of it is missing
};

/// Returns the shapes of all structures with voxels in the case's table, in the table's order. All sums are of
/// integers, so that the number of threads does not change them.
std::vector<StructureShape> structure_shapes(const Case& subject);

/// Returns the shape of the structure with that name, or null.
const StructureShape* find_shape(const std::vector<StructureShape>& shapes, std::string_view name);

/// Returns the centre of the part of a structure within `half_mm` of the height `z_mm`, or nothing if that part is
/// empty.
std::optional<glm::dvec3> centre_at_height(const Case& subject, const StructureShape& shape, double z_mm,
                                           double half_mm);

/// The place where two structures come closest.
struct Contact {
  glm::dvec3 point{0.0};  ///< halfway between them, near the middle of the closest region
  double gap_mm = 0;      ///< smallest distance between voxel centres
};

/// Returns the contact, or nothing if they are nowhere closer than `most_mm`.
std::optional<Contact> contact_between(const Case& subject, const StructureShape& a, const StructureShape& b,
                                       double most_mm);

}  // namespace insonate
