#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "sim/core/grid.h"
#include "sim/reconstruction/tracked_picture.h"

namespace insonate {

/// The most voxels of a reconstructed volume. Its sums then take 256 MiB, and a result 64 MiB.
inline constexpr std::size_t kMaxReconstructedVoxels = std::size_t(1) << 25;
/// The most voxels along one side, so that any graphics card holds the volume as a texture.
inline constexpr int kMaxReconstructedSide = 1024;

/// The frame and the extent of pictures' regions in it.
struct SweepExtent {
  Pose patient_from_sweep;               ///< axes of the mean plane: x along its rows, y along its columns
  glm::dvec3 low_mm{0.0}, high_mm{0.0};  ///< in that frame
};

/// Returns the extent of all pictures in the frame of their mean plane: the rotation nearest to the mean of the
/// pictures' own, or that of the middle picture if they point in all directions.
/// @param pictures  at least one
SweepExtent extent_of(std::span<const TrackedPicture> pictures);

/// A grid, and a sentence if its voxels are larger than was asked for.
struct GridChoice {
  Grid grid;
  std::string remark;  ///< empty, or why the voxels are larger
};

/// Returns a grid of cubic voxels around all pictures, with one voxel of margin. Its axes are those of the mean plane:
/// i lateral, j into the depth, k along the elevation. Voxels are enlarged by steps of a tenth until there are at most
/// `most_voxels`, and at most kMaxReconstructedSide along each side.
/// @param pictures     at least one
/// @param voxel_mm     0.05 to 20
/// @param most_voxels  at least 1000
GridChoice choose_grid(std::span<const TrackedPicture> pictures, double voxel_mm,
                       std::size_t most_voxels = kMaxReconstructedVoxels);

}  // namespace insonate
