#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sim/image_headers/element_type.h"

namespace insonate {

/// Where the voxels of a volume lie, and how they are stored.
struct VoxelData {
  ElementType type = ElementType::int16;
  bool big_endian = false;
  double slope = 1, intercept = 0;  ///< value = slope * stored number + intercept
  std::filesystem::path file;       ///< the file itself, or the data file that a detached header names
  std::uint64_t offset = 0;         ///< of the voxels in that file, or of the packed stream that holds them
  bool packed = false;              ///< by zlib or gzip
  std::uint64_t skipped = 0;        ///< bytes of the packed stream in front of the voxels
};

/// Throws InputError if the data file does not exist or cannot hold `count` voxels. For a packed file it checks only
/// that so few bytes can become so many; read_values() checks the rest.
/// @param header_file  the file's name in error messages, here and below
void check_voxel_data(const std::filesystem::path& header_file, const VoxelData& data, std::uint64_t count);

/// Sets `values` to the values of `count` stored voxels, of which only type, order of bytes and rescale are used.
void decode(const VoxelData& data, const char* bytes, std::size_t count, std::vector<double>& values);

/// Calls `take` with the values of all voxels in the file's order, some at a time, so that memory grows with what the
/// file really holds. Throws InputError if the file holds fewer or more than `count` voxels, or is damaged.
void read_values(const std::filesystem::path& header_file, const VoxelData& data, std::uint64_t count,
                 const std::function<void(const std::vector<double>& values)>& take);

}  // namespace insonate
