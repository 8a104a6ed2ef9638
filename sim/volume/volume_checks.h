#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "sim/core/grid.h"

namespace insonate {

/// The limits that read_ct() documents. 4096 voxels per side are twice what scanners write; 2^31 int16 voxels are 4
/// GiB.
inline constexpr std::uint64_t kMaxVoxelsPerSide = 4096;
inline constexpr std::uint64_t kMaxVoxels = std::uint64_t(1) << 31;
/// The largest distance of the origin from zero along an axis. A scanner's table is 2 m long.
inline constexpr double kFurthestOrigin_mm = 1e6;

/// Throws InputError for a problem in the header of a volume file.
[[noreturn]] void refuse_header(const std::filesystem::path& file, const std::string& problem,
                                const std::string& remedy);

/// Throws InputError for sizes that no volume has: a side with fewer than 2 or too many voxels, or too many voxels in
/// all.
/// @param file  the file's name in the message, here and below
void check_size(const std::string& file, std::uint64_t i, std::uint64_t j, std::uint64_t k);

/// Throws InputError for a volume that is too small or too large for a body, as with a spacing that is not in mm: below
/// 20 mm or above 3 m along an axis.
void check_body_size(const std::string& file, const glm::ivec3& size, const glm::dvec3& spacing);

/// Throws InputError for a rescale that no CT has: one that is not finite, shrinks all values to one, inverts them, or
/// moves them out of range.
/// @param slope_name, intercept_name  their names in the file's format
void check_rescale(const std::string& file, const std::string& slope_name, double slope,
                   const std::string& intercept_name, double intercept);

/// Throws InputError for a spacing that is not a positive number. checked_grid() checks its range.
/// @param remedy  what to do about it
void check_positive_spacing(const std::string& file, const glm::dvec3& spacing, const std::string& remedy);

/// Throws InputError if spacing or origin is out of range, or the direction matrix is not orthogonal. Returns the grid
/// without the small non-orthogonality that rounding in the file causes.
Grid checked_grid(const std::string& file, Grid grid);

}  // namespace insonate
