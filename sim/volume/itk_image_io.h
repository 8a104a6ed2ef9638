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
std::size_t bytes_of(VoxelType type);

enum class ImageFormat { nifti, nrrd, meta_image, dicom };

/// An image file as ITK reads it, one dimension after the other as they are stored, not yet judged: sizes may be absurd
/// and directions singular. Positions and directions are in LPS. ITK stays behind this class: its headers, its
/// exceptions (each becomes an InputError of other words) and its warnings (none are printed).
class ImageFile {
public:
  /// Reads the header and not a voxel.
  ImageFile(const std::filesystem::path& file, ImageFormat format);
  ~ImageFile();
  ImageFile(const ImageFile&) = delete;
  ImageFile& operator=(const ImageFile&) = delete;

  struct Axis {
    std::uint64_t size = 0;
    double spacing = 0;
    double origin = 0;              ///< this coordinate of the first voxel's centre
    std::vector<double> direction;  ///< as many numbers as the image has axes
  };
  const std::vector<Axis>& axes() const { return axes_; }
  int components() const { return components_; }  ///< 1 for scalars, 3 for RGB
  VoxelType voxel_type() const { return type_; }  ///< of what read_voxels() returns: after the header's rescale

  /// All voxels as the file orders them, of voxel_type().
  std::unique_ptr<std::byte[]> read_voxels();

private:
  struct Reader;
  std::unique_ptr<Reader> reader_;
  std::filesystem::path file_;
  std::vector<Axis> axes_;
  int components_ = 0;
  VoxelType type_ = VoxelType::int16;
};

/// Writes a 3D scalar NRRD file, raw or gzip, atomically.
void write_nrrd(const std::filesystem::path& file, const Grid& grid, VoxelType type, const void* voxels, bool gzip);

}  // namespace insonate
