#include "sim/volume/dicom_image.h"

#include <gdcmImageHelper.h>
#include <gdcmImageReader.h>
#include <gdcmRescaler.h>

#include <bit>
#include <cstring>
#include <map>
#include <optional>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/volume/voxel_data.h"

namespace insonate {
namespace {

const char* const kExportUncompressed = "export it again, uncompressed";

std::optional<ElementType> type_of(gdcm::PixelFormat::ScalarType type) {
  using Format = gdcm::PixelFormat;
  static const std::map<Format::ScalarType, ElementType> types = {
      {Format::INT8, ElementType::int8},       {Format::UINT8, ElementType::uint8},
      {Format::INT12, ElementType::int16},     {Format::UINT12, ElementType::uint16},
      {Format::INT16, ElementType::int16},     {Format::UINT16, ElementType::uint16},
      {Format::INT32, ElementType::int32},     {Format::UINT32, ElementType::uint32},
      {Format::FLOAT32, ElementType::float32}, {Format::FLOAT64, ElementType::float64}};
  const auto known = types.find(type);
  return known == types.end() ? std::nullopt : std::optional(known->second);
}

}  // namespace

DicomImage read_dicom_image(const std::filesystem::path& file, const glm::uvec2& size) {
  // The rescale may be at the top of any kind of image; check_dicom_slice() has compared it with where GDCM expects it.
  gdcm::ImageHelper::SetForceRescaleInterceptSlope(true);
  gdcm::ImageReader reader;
  reader.SetFileName(file.c_str());
  gdcm::Rescaler rescaler;
  std::optional<ElementType> stored_type, type;
  const bool is_read = reader.Read();
  const gdcm::Image& image = reader.GetImage();
  const gdcm::PixelFormat& stored = image.GetPixelFormat();
  if (is_read) {
    rescaler.SetIntercept(image.GetIntercept());
    rescaler.SetSlope(image.GetSlope());
    rescaler.SetPixelFormat(stored);
    stored_type = type_of(stored);
    type = type_of(rescaler.ComputeInterceptSlopePixelType());
  }
  if (!stored_type || !type)
    throw InputError(file.string(), "header", "the header of its image is damaged or of a kind that is not read here",
                     kExportUncompressed);
  const unsigned* const dimensions = image.GetDimensions();
  const bool is_one = image.GetNumberOfDimensions() < 3 || dimensions[2] == 1;
  if (stored.GetSamplesPerPixel() != 1 || !is_one ||
      (size != glm::uvec2(0) && size != glm::uvec2(dimensions[0], dimensions[1])))
    throw InputError(file.string(), "header", "it is not a grey image of the series' size", "export the series again");

  const std::size_t count = std::size_t(dimensions[0]) * dimensions[1];
  std::vector<char> bytes(count * bytes_of(*stored_type));
  if (image.GetBufferLength() != bytes.size() || !image.GetBuffer(bytes.data()))
    throw InputError(file.string(), "voxels", "the voxels are damaged or packed in a way that is not read here",
                     kExportUncompressed);
  if (image.GetSlope() != 1 || image.GetIntercept() != 0) {
    std::vector<char> scaled(count * bytes_of(*type));
    rescaler.Rescale(scaled.data(), bytes.data(), bytes.size());
    bytes.swap(scaled);
  }
  VoxelData native;
  native.type = *type;
  native.big_endian = std::endian::native == std::endian::big;
  DicomImage read{to_string(*type), {}};
  decode(native, bytes.data(), count, read.values);
  return read;
}

void check_raw_pixels(const std::filesystem::path& file, std::uint64_t needed, bool is_big_endian) {
  // The element (7fe0,0010) with the image's own length. An icon image has another length.
  const std::string bytes = read_file(file);
  const char* const tag = is_big_endian ? "\x7f\xe0\x00\x10" : "\xe0\x7f\x10\x00";
  for (std::size_t at = 0; (at = bytes.find(tag, at, 4)) != std::string::npos; ++at) {
    const bool explicit_type = bytes.compare(at + 4, 2, "OW") == 0 || bytes.compare(at + 4, 2, "OB") == 0;
    const std::size_t length_at = at + (explicit_type ? 8 : 4);
    std::uint32_t length = 0;
    if (length_at + sizeof length > bytes.size()) break;
    std::memcpy(&length, bytes.data() + length_at, sizeof length);
    if (is_big_endian) length = __builtin_bswap32(length);
    if (length != needed + needed % 2) continue;
    if (bytes.size() - length_at - sizeof length >= length) return;
    throw InputError(file.string(), "voxels", "the file ends before its image does", "export it again");
  }
  throw InputError(file.string(), "voxels", "it holds no image of the size that its header gives", "export it again");
}

}  // namespace insonate
