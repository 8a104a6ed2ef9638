#include "sim/view/axis_slice.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace insonate::view {
namespace {

struct PatientBox {
  glm::dvec3 low, high;
};

/// Returns the box along the patient's axes around all of a volume's voxels, mm.
PatientBox box_around(const Grid& volume) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  PatientBox box{glm::dvec3(kFar), glm::dvec3(-kFar)};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 at(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::dvec3 p = volume.patient_from_index(at * glm::dvec3(volume.size) - 0.5);
    box.low = glm::min(box.low, p);
    box.high = glm::max(box.high, p);
  }
  return box;
}

/// Returns the picture's directions in the patient's frame: right, down, and into the picture.
glm::dmat3 directions(SliceAxis axis) {
  const glm::dvec3 left(1, 0, 0), back(0, 1, 0), head(0, 0, 1);
  switch (axis) {
    case SliceAxis::axial:
      return {left, back, head};
    case SliceAxis::coronal:
      return {left, -head, back};
    case SliceAxis::sagittal:
      return {back, -head, -left};
  }
  return glm::dmat3(1.0);
}

}  // namespace

int normal_axis(SliceAxis axis) {
  return axis == SliceAxis::axial ? 2 : axis == SliceAxis::coronal ? 1 : 0;
}

AxisSlice AxisSlice::fitting(SliceAxis axis, const Grid& volume, const glm::dvec3& through, int width, int height) {
  const PatientBox box = box_around(volume);
  AxisSlice slice;
  slice.axis = axis;
  slice.middle = (box.low + box.high) / 2.0;
  const int normal = normal_axis(axis);
  // Voxels at the very border are half air.
  const double border = std::min(slice_step_mm(axis, volume), box.high[normal] - box.low[normal]) / 2;
  slice.middle[normal] = std::clamp(through[normal], box.low[normal] + border, box.high[normal] - border);
  const glm::dvec3 extent = glm::abs(glm::transpose(directions(axis)) * (box.high - box.low));
  slice.mm_per_pixel = std::max(extent.x / width, extent.y / height);
  slice.width = width;
  slice.height = height;
  return slice;
}

Pose AxisSlice::patient_from_picture() const {
  return {directions(axis), middle};
}

glm::dvec2 AxisSlice::pixel(const glm::dvec3& patient_mm) const {
  return glm::dvec2(patient_from_picture().inverse().point(patient_mm)) / mm_per_pixel +
         glm::dvec2(width, height) / 2.0;
}

glm::dvec3 AxisSlice::patient_mm(const glm::dvec2& pixel) const {
  return patient_from_picture().point(glm::dvec3((pixel - glm::dvec2(width, height) / 2.0) * mm_per_pixel, 0));
}

double slice_step_mm(SliceAxis axis, const Grid& volume) {
  const int normal = normal_axis(axis);
  int nearest = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(volume.direction[i][normal]) > std::abs(volume.direction[nearest][normal])) nearest = i;
  return volume.spacing[nearest];
}

}  // namespace insonate::view
