#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "sim/core/grid.h"
#include "sim/core/pose.h"

namespace insonate::view {

/// The planes along the patient's axes. Each value is used as an index.
enum class SliceAxis { axial, coronal, sagittal };

/// Returns the axis of the patient's frame (0 x, 1 y, 2 z) that a slice cuts across.
int normal_axis(SliceAxis axis);

/// A slice along two of the patient's axes, and how a picture shows it. Radiological convention: axial from the feet,
/// with the patient's right on the left and the front up; coronal from the front; sagittal from the patient's left,
/// with the front on the left.
struct AxisSlice {
  SliceAxis axis = SliceAxis::axial;
  glm::dvec3 middle{0.0};  ///< the patient's point at the picture's middle, mm
  double mm_per_pixel = 1;
  int width = 1, height = 1;  ///< pixels

  bool operator==(const AxisSlice&) const = default;

  /// Returns the slice through `through` that shows the whole volume, as large as it fits into the picture. A point
  /// beyond the volume gives the volume's outermost slice.
  /// @param width, height  of the picture, pixels, > 0
  static AxisSlice fitting(SliceAxis axis, const Grid& volume, const glm::dvec3& through, int width, int height);

  /// Returns the pose of the picture's middle: x to the right, y down, z into the picture.
  Pose patient_from_picture() const;
  /// Returns where a point of the patient lies in the picture, seen along the slice's normal, in pixels. (0, 0) is the
  /// top left corner, and whole numbers are edges of pixels.
  glm::dvec2 pixel(const glm::dvec3& patient_mm) const;
  /// Returns the patient's point of a place in the picture, mm.
  glm::dvec3 patient_mm(const glm::dvec2& pixel) const;
};

/// Returns the distance between two slices of a volume along one of the patient's axes, mm: the voxel's extent along
/// the volume's axis that is nearest to it.
double slice_step_mm(SliceAxis axis, const Grid& volume);

}  // namespace insonate::view
