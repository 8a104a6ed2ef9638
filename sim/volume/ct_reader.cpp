#include "sim/volume/ct_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "sim/core/input_error.h"
#include "sim/volume/itk_image_io.h"
#include "sim/volume/volume_checks.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

constexpr double kLeastHu = -1024, kMostHu = 32767;

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

ImageFormat format_of(const fs::path& file) {
  const std::string name = lower_case(file.filename().string());
  if (ends_with(name, ".nii") || ends_with(name, ".nii.gz")) return ImageFormat::nifti;
  if (ends_with(name, ".nrrd") || ends_with(name, ".nhdr")) return ImageFormat::nrrd;
  if (ends_with(name, ".mha") || ends_with(name, ".mhd")) return ImageFormat::meta_image;
  throw InputError(file.string(), "", "the name does not end as a volume's does",
                   "give a .nii, .nii.gz, .nrrd, .nhdr, .mha or .mhd file, or a DICOM folder");
}

const char* format_name(ImageFormat format) {
  switch (format) {
    case ImageFormat::nifti:
      return "NIfTI";
    case ImageFormat::nrrd:
      return "NRRD";
    case ImageFormat::meta_image:
      return "MetaImage";
    case ImageFormat::dicom:
      break;
  }
  return "DICOM series";
}

/// Calls `use(span of the voxels' own type)`.
template <typename Use>
void with_typed(VoxelType type, const std::byte* bytes, Use use) {
  switch (type) {
    case VoxelType::int8:
      return use(reinterpret_cast<const std::int8_t*>(bytes));
    case VoxelType::uint8:
      return use(reinterpret_cast<const std::uint8_t*>(bytes));
    case VoxelType::int16:
      return use(reinterpret_cast<const std::int16_t*>(bytes));
    case VoxelType::uint16:
      return use(reinterpret_cast<const std::uint16_t*>(bytes));
    case VoxelType::int32:
      return use(reinterpret_cast<const std::int32_t*>(bytes));
    case VoxelType::uint32:
      return use(reinterpret_cast<const std::uint32_t*>(bytes));
    case VoxelType::int64:
      return use(reinterpret_cast<const std::int64_t*>(bytes));
    case VoxelType::uint64:
      return use(reinterpret_cast<const std::uint64_t*>(bytes));
    case VoxelType::float32:
      return use(reinterpret_cast<const float*>(bytes));
    case VoxelType::float64:
      return use(reinterpret_cast<const double*>(bytes));
  }
}

std::string voxel_at(const Grid& grid, std::size_t offset) {
  const std::size_t x = std::size_t(grid.size.x), y = std::size_t(grid.size.y);
  return "voxel (" + std::to_string(offset % x) + ", " + std::to_string(offset / x % y) + ", " +
         std::to_string(offset / (x * y)) + ")";
}

fs::path existing_file(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) throw InputError(file.string(), "", "there is no such file", "check the name");
  if (!fs::is_regular_file(status))
    throw InputError(file.string(), "", "it is no ordinary file", "name a file on disk");
  if (fs::file_size(file, error) == 0) throw InputError(file.string(), "", "the file is empty", "copy it again");
  return file;
}

}  // namespace

Volume<std::int16_t> read_ct(const fs::path& file_or_folder, CtSource* source) {
  const std::string name = file_or_folder.string();
  const fs::path file = existing_file(file_or_folder);
  const ImageFormat format = format_of(file);
  ImageFile image(file, format);
  Volume<std::int16_t> ct{checked_grid(name, image), {}};
  const auto bytes = image.read_voxels();
  ct.voxels.resize(ct.grid.count());
  std::size_t clamped = 0;
  with_typed(image.voxel_type(), bytes.get(), [&](const auto* voxels) {
    for (std::size_t v = 0; v < ct.voxels.size(); ++v) {
      const double hu = double(voxels[v]);
      if (!std::isfinite(hu))
        throw InputError(name, voxel_at(ct.grid, v), "the value is not a finite number", "export the CT again");
      const double kept = std::clamp(hu, kLeastHu, kMostHu);
      clamped += kept != hu;
      ct.voxels[v] = std::int16_t(std::lround(kept));
    }
  });
  if (source) *source = {format_name(format), to_string(image.voxel_type()), {}, clamped};
  return ct;
}

Volume<std::uint8_t> read_labels(const fs::path& file) {
  ImageFile image(existing_file(file), format_of(file));
  Volume<std::uint8_t> labels{checked_grid(file.string(), image), {}};
  const auto bytes = image.read_voxels();
  labels.voxels.resize(labels.grid.count());
  with_typed(image.voxel_type(), bytes.get(), [&](const auto* voxels) {
    for (std::size_t v = 0; v < labels.voxels.size(); ++v) {
      const double value = double(voxels[v]);
      if (!(value >= 0 && value <= 255 && value == std::floor(value)))
        throw InputError(file.string(), voxel_at(labels.grid, v), "the value is no whole number from 0 to 255",
                         "give a label volume, not a CT");
      labels.voxels[v] = std::uint8_t(value);
    }
  });
  return labels;
}

void write_ct(const fs::path& nrrd_file, const Volume<std::int16_t>& ct) {
  write_nrrd(nrrd_file, ct.grid, VoxelType::int16, ct.voxels.data(), false);
}

void write_labels(const fs::path& nrrd_file, const Volume<std::uint8_t>& labels) {
  write_nrrd(nrrd_file, labels.grid, VoxelType::uint8, labels.voxels.data(), false);
}

}  // namespace insonate
