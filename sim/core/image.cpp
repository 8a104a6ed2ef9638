#include "sim/core/image.h"

#include <png.h>

#include "sim/core/files.h"
#include "sim/core/input_error.h"

namespace insonate {
namespace {

void write(const std::filesystem::path& file, int width, int height, png_uint_32 format, const void* pixels) {
  write_atomically(file, [&](const std::filesystem::path& temporary) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = png_uint_32(width);
    png.height = png_uint_32(height);
    png.format = format;
    if (!png_image_write_to_file(&png, temporary.c_str(), 0, pixels, 0, nullptr))
      throw InputError(file.string(), "", std::string("the picture cannot be written (") + png.message + ")",
                       "check the folder's permissions and free space");
  });
}

}  // namespace

void write_png(const std::filesystem::path& file, const Image<std::uint8_t>& grey) {
  write(file, grey.width, grey.height, PNG_FORMAT_GRAY, grey.pixels.data());
}

void write_png(const std::filesystem::path& file, const Image<Rgba8>& image) {
  write(file, image.width, image.height, PNG_FORMAT_RGBA, image.pixels.data());
}

}  // namespace insonate
