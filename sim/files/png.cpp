#include "sim/files/png.h"

#include <png.h>

#include <stdexcept>

#include "sim/core/input_error.h"
#include "sim/files/files.h"

namespace insonate {
namespace {

constexpr png_uint_32 kMaxPixels = 8192;  // along a side

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

Image<std::uint8_t> read_png(const std::filesystem::path& file) {
  check_is_file(file);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const auto refuse = [&](const std::string& why) {
    png_image_free(&png);
    throw InputError(file.string(), "", why, "give a PNG with at most 8192 x 8192 pixels");
  };
  if (!png_image_begin_read_from_file(&png, file.c_str()))
    refuse(std::string("it cannot be read as a PNG (") + png.message + ")");
  if (png.width > kMaxPixels || png.height > kMaxPixels)
    refuse("it has " + std::to_string(png.width) + " x " + std::to_string(png.height) + " pixels");
  png.format = PNG_FORMAT_GRAY;
  Image<std::uint8_t> image(int(png.width), int(png.height));
  const png_color black{0, 0, 0};
  if (!png_image_finish_read(&png, &black, image.pixels.data(), 0, nullptr))
    refuse(std::string("it is damaged (") + png.message + ")");
  return image;
}

namespace {

std::string packed(int width, int height, png_uint_32 format, const void* pixels) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = png_uint_32(width);
  png.height = png_uint_32(height);
  png.format = format;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, pixels, 0, nullptr))
    throw std::runtime_error(std::string("the picture cannot be packed (") + png.message + ")");
  bytes.resize(size);
  return bytes;
}

}  // namespace

std::string png_bytes(const Image<std::uint8_t>& grey) {
  return packed(grey.width, grey.height, PNG_FORMAT_GRAY, grey.pixels.data());
}

std::string png_bytes(const Image<Rgba8>& image) {
  return packed(image.width, image.height, PNG_FORMAT_RGBA, image.pixels.data());
}

}  // namespace insonate
