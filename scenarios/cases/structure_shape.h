#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/volume/case.h"

namespace insonate {

/// The axis or its opposite: the one that points to the head, the patient's right or the front, whichever of these it
/// runs along most. Probes' markers are held that way, and structures' axes named.
glm::dvec3 marker_side(const glm::dvec3& axis);

/// Where an axis points to, as a word for names: "upper", "lower", "right", "left", "front" or "back".
std::string end_of_axis(const glm::dvec3& axis);

/// What a labelled structure looks like as a solid, voxels taken as boxes. Patient, mm.
///
/// The axes are the principal axes of its voxels, each on its marker_side().
struct StructureShape {
  Label label;
  std::size_t voxels = 0;
  glm::ivec3 low{0}, high{0};    ///< the box of its voxels, ends included
  glm::dvec3 centroid{0.0};      ///< of all its voxels, wherever that lies
  glm::dvec3 centre{0.0};        ///< the centroid, or its voxel nearest to it where the centroid lies outside
  glm::dmat3 axes{1.0};          ///< unit columns, the longest first
  glm::dvec3 deviation_mm{0.0};  ///< standard deviation of its volume along each axis, falling
  glm::dvec3 first_pole{0.0};    ///< the centre of what lies in the outermost 5 % of its length, where the long axis
  glm::dvec3 second_pole{0.0};   ///< points to, and at the other end
  bool cut = false;              ///< it reaches the CT's first or last slice along some axis: part of it is missing
};

/// The shapes of all that the case's table lists and its volume holds, in the table's order. All sums are of whole
/// numbers, so that threads do not change them.
std::vector<StructureShape> structure_shapes(const Case& subject);

/// The centre of what of a structure lies within `half_mm` of the height `z_mm`; empty when nothing does.
std::optional<glm::dvec3> centre_at_height(const Case& subject, const StructureShape& shape, double z_mm,
                                           double half_mm);

/// Where two structures come closest.
struct Contact {
  glm::dvec3 point{0.0};  ///< half way between them, near the middle of where they are as close as they get
  double gap_mm = 0;      ///< the least distance between voxels' centres
};

/// Empty when they are nowhere nearer than `most_mm`.
std::optional<Contact> contact_between(const Case& subject, const StructureShape& a, const StructureShape& b,
                                       double most_mm);

}  // namespace insonate
