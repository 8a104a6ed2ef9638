#include "sim/core/png_bytes.h"

#include <png.h>

#include <stdexcept>

namespace insonate {

std::string png_bytes(const Image<std::uint8_t>& grey) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = png_uint_32(grey.width);
  png.height = png_uint_32(grey.height);
  png.format = PNG_FORMAT_GRAY;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, grey.pixels.data(), 0, nullptr))
    throw std::runtime_error(std::string("the picture cannot be packed (") + png.message + ")");
  bytes.resize(size);
  return bytes;
}

}  // namespace insonate
