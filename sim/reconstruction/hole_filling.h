#pragma once

#include "sim/reconstruction/reconstruction.h"

namespace insonate {

/// Fills the unseen voxels of a volume that lie between measured ones, as between the pictures of a sweep.
///
/// A voxel is filled if, along one of the 13 straight lines through it and its neighbours, measured voxels lie on both
/// sides and at most 2 `radius_mm` from each other. Its value is the mean of the linear interpolations along all such
/// lines, with the weights 1 / distance^2. So nothing is filled outside the convex hull of the measured voxels or
/// farther than `radius_mm` from one. Filled voxels do not fill others.
/// @param radius_mm  0 or more
void fill_holes(ReconstructedVolume& volume, double radius_mm);

}  // namespace insonate
