#include "sim/reconstruction/sweep_extent.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cstdio>
#include <limits>

namespace insonate {
namespace {

Pose mean_plane(std::span<const TrackedPicture> pictures) {
  // Below this the rotations cancel out, and the nearest rotation would be arbitrary.
  constexpr double kMinDeterminant = 0.1;
  glm::dmat3 sum(0.0);
  for (const TrackedPicture& picture : pictures) sum += plane_of(picture.patient_from_pixel).rotation;
  sum /= double(pictures.size());
  const Pose middle = plane_of(pictures[pictures.size() / 2].patient_from_pixel);
  if (glm::determinant(sum) < kMinDeterminant) return middle;
  return {pose_from_matrix(glm::dmat4(sum)).rotation, middle.translation};
}

Grid grid_of(const SweepExtent& extent, double voxel_mm) {
  constexpr int kMargin = 1;
  Grid grid;
  grid.size = glm::ivec3(glm::ceil((extent.high_mm - extent.low_mm) / voxel_mm)) + 1 + 2 * kMargin;
  grid.spacing = glm::dvec3(voxel_mm);
  grid.direction = extent.patient_from_sweep.rotation;
  const glm::dvec3 centre = (extent.low_mm + extent.high_mm) / 2.0;
  grid.origin = extent.patient_from_sweep.point(centre - voxel_mm * (glm::dvec3(grid.size) - 1.0) / 2.0);
  return grid;
}

}  // namespace

SweepExtent extent_of(std::span<const TrackedPicture> pictures) {
  SweepExtent extent{mean_plane(pictures), glm::dvec3(std::numeric_limits<double>::max()),
                     glm::dvec3(std::numeric_limits<double>::lowest())};
  const glm::dmat4 sweep_from_patient = extent.patient_from_sweep.inverse().matrix();
  for (const TrackedPicture& picture : pictures) {
    const glm::dmat4 sweep_from_pixel = sweep_from_patient * picture.patient_from_pixel;
    for (const glm::dvec2& pixel : picture.region->outline) {
      const glm::dvec3 point(sweep_from_pixel * glm::dvec4(pixel, 0, 1));
      extent.low_mm = glm::min(extent.low_mm, point);
      extent.high_mm = glm::max(extent.high_mm, point);
    }
  }
  return extent;
}

GridChoice choose_grid(std::span<const TrackedPicture> pictures, double voxel_mm, std::size_t most_voxels) {
  constexpr double kStep = 1.1;
  const SweepExtent extent = extent_of(pictures);
  const auto fits = [&](double voxel) {
    // Compared as real numbers: the sizes of a stray pose do not fit an int.
    const glm::dvec3 size = glm::ceil((extent.high_mm - extent.low_mm) / voxel) + 3.0;
    return size.x * size.y * size.z <= double(most_voxels) &&
           std::max({size.x, size.y, size.z}) <= kMaxReconstructedSide;
  };
  double taken_mm = voxel_mm;
  while (!fits(taken_mm)) taken_mm *= kStep;
  GridChoice choice{grid_of(extent, taken_mm), ""};
  if (taken_mm > voxel_mm) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "The volume has voxels of %.2f mm, because those of %.2f mm would be more than fit.", taken_mm,
                  voxel_mm);
    choice.remark = text;
  }
  return choice;
}

}  // namespace insonate
