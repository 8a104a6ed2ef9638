#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sim/core/grid.h"

namespace insonate {

/// The types a voxel can have in a file.
enum class VoxelType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

std::string to_string(VoxelType type);
/// Returns the bytes per voxel.
std::size_t bytes_of(VoxelType type);

enum class ImageFormat { nifti, nrrd, meta_image, dicom };

/// Reads an image file through ITK. The axes are in the file's order and not yet checked: sizes may be absurd and
/// directions singular. Positions and directions are in LPS. This class hides ITK: its headers, its exceptions (each
/// becomes an InputError with its own text) and its warnings (none are printed).
class ImageFile {
public:
  /// Reads the header only. Throws InputError.
  ImageFile(const std::filesystem::path& file, ImageFormat format);
  ~ImageFile();
  ImageFile(const ImageFile&) = delete;
  ImageFile& operator=(const ImageFile&) = delete;

  struct Axis {
    std::uint64_t size = 0;
    double spacing = 0;
    double origin = 0;              ///< this axis's coordinate of the first voxel's centre
    std::vector<double> direction;  ///< one number per axis of the image
  };
  const std::vector<Axis>& axes() const { return axes_; }
  int components() const { return components_; }  ///< 1 for scalars, 3 for RGB
  VoxelType voxel_type() const { return type_; }  ///< type of the voxels from read_voxels(): after the header's rescale

  /// Returns all voxels in the file's order, with type voxel_type(). Throws InputError.
  std::unique_ptr<std::byte[]> read_voxels();

private:
  struct Reader;
  std::unique_ptr<Reader> reader_;
  std::filesystem::path file_;
  std::vector<Axis> axes_;
  int components_ = 0;
  VoxelType type_ = VoxelType::int16;
};

/// Writes a 3D scalar NRRD file, raw or gzip, atomically. Throws InputError.
void write_nrrd(const std::filesystem::path& file, const Grid& grid, VoxelType type, const void* voxels, bool gzip);

}  // namespace insonate
