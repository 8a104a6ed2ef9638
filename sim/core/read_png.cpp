#include "sim/core/read_png.h"

#include <png.h>

#include <string>

#include "sim/core/input_error.h"

namespace insonate {
namespace {

constexpr png_uint_32 kMostPixels = 8192;  // along a side

}  // namespace

Image<std::uint8_t> read_png(const std::filesystem::path& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const auto refuse = [&](const std::string& why) {
    png_image_free(&png);
    throw InputError(file.string(), "", why, "give a PNG with at most 8192 x 8192 pixels");
  };
  if (!png_image_begin_read_from_file(&png, file.c_str()))
    refuse(std::string("it cannot be read as a PNG (") + png.message + ")");
  if (png.width > kMostPixels || png.height > kMostPixels)
    refuse("it has " + std::to_string(png.width) + " x " + std::to_string(png.height) + " pixels");
  png.format = PNG_FORMAT_GRAY;
  Image<std::uint8_t> image(int(png.width), int(png.height));
  const png_color black{0, 0, 0};
  if (!png_image_finish_read(&png, &black, image.pixels.data(), 0, nullptr))
    refuse(std::string("it is damaged (") + png.message + ")");
  return image;
}

}  // namespace insonate
