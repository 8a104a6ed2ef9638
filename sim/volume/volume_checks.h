#pragma once

#include <cstdint>
#include <string>

#include "sim/core/grid.h"

namespace insonate {

class ImageFile;

/// The limits that read_ct() documents. 4096 voxels a side are twice what scanners write; 2^31 int16 voxels are 4 GiB.
inline constexpr std::uint64_t kMostVoxelsASide = 4096;
inline constexpr std::uint64_t kMostVoxels = std::uint64_t(1) << 31;
/// How far the origin may lie from zero along an axis. A scanner's table is 2 m long.
inline constexpr double kFurthestOriginMm = 1e6;

/// Throws the InputError for sizes no volume may have: a side of fewer than 2 or too many voxels, or too many in all.
void check_size(const std::string& file, std::uint64_t i, std::uint64_t j, std::uint64_t k);

/// Throws the InputError for a volume that is too small or too large for a body, as when its spacing is not in mm:
/// under 20 mm or over 3 m along an axis.
void check_body_size(const std::string& file, const glm::ivec3& size, const glm::dvec3& spacing);

/// Throws the InputError for a rescale that no CT has: one that is not finite, shrinks all values to one, turns high
/// into low, or moves them out of range.
/// @param slope_name, intercept_name  as the file's format calls them
void check_rescale(const std::string& file, const std::string& slope_name, double slope,
                   const std::string& intercept_name, double intercept);

/// The grid that an image's header describes. Throws InputError when that is no 3D scalar volume within the limits with
/// finite positions, positive spacing and an orthogonal direction matrix. What rounding in the file left of
/// non-orthogonality is removed.
Grid checked_grid(const std::string& file, const ImageFile& image);

/// The same for a grid at hand: spacing, origin and direction.
Grid checked_grid(const std::string& file, Grid grid);

}  // namespace insonate
