// The IMAGE messages of OpenIGTLink.

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>

#include "devices/igtl/igtl_message.h"

namespace insonate::igtl {
namespace {

// u16 version, u8 components, u8 type, u8 endian, u8 coordinates, 3 u16 size, 12 f32 place, 3 u16 first and 3 u16 size
// of the part that follows.
constexpr std::size_t kPixels = 72;

enum Type { kInt8 = 2, kUint8 = 3, kInt16 = 4, kUint16 = 5, kInt32 = 6, kUint32 = 7, kFloat32 = 10, kFloat64 = 11 };

std::size_t bytes_of(int type) {
  switch (type) {
    case kInt8:
    case kUint8:
      return 1;
    case kInt16:
    case kUint16:
      return 2;
    case kInt32:
    case kUint32:
    case kFloat32:
      return 4;
    case kFloat64:
      return 8;
    default:
      return 0;
  }
}

template <typename Unsigned>
Unsigned number_at(const std::uint8_t* bytes, bool little) {
  Unsigned number = 0;
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i)
    number = Unsigned(number << 8) | Unsigned(bytes[little ? sizeof(Unsigned) - 1 - i : i]);
  return number;
}

double value_at(const std::uint8_t* bytes, int type, bool little) {
  switch (type) {
    case kInt8:
      return std::int8_t(*bytes);
    case kUint8:
      return *bytes;
    case kInt16:
      return std::int16_t(number_at<std::uint16_t>(bytes, little));
    case kUint16:
      return number_at<std::uint16_t>(bytes, little);
    case kInt32:
      return std::int32_t(number_at<std::uint32_t>(bytes, little));
    case kUint32:
      return number_at<std::uint32_t>(bytes, little);
    case kFloat32:
      return double(std::bit_cast<float>(number_at<std::uint32_t>(bytes, little)));
    default:
      return std::bit_cast<double>(number_at<std::uint64_t>(bytes, little));
  }
}

struct Size {
  std::size_t x, y, z;
};

Size size_at(ByteView content, std::size_t at) {
  const auto one = [&](std::size_t i) {
    return std::size_t(number_at<std::uint16_t>(content.data() + at + 2 * i, false));
  };
  return {one(0), one(1), one(2)};
}

std::string text(const Size& size) {
  return std::to_string(size.x) + " x " + std::to_string(size.y) + " x " + std::to_string(size.z);
}

}  // namespace

std::variant<ReceivedImage, std::string> parse_image(ByteView content) {
  if (content.size() < kPixels) return "is shorter than its header";
  const std::size_t components = content[2];
  const int type = content[3];
  const bool little = content[4] == 2;
  const Size size = size_at(content, 6), first = size_at(content, 60), part = size_at(content, 66);
  const std::size_t each = bytes_of(type);
  if (each == 0) return "has pixels of the unknown type " + std::to_string(type);
  if (components != 1 && components != 3 && components != 4)
    return "has " + std::to_string(components) + " components per pixel, not 1, 3 or 4";
  if (size.z != 1) return "has " + std::to_string(size.z) + " slices, not one";
  if (size.x < 2 || size.y < 2) return "has " + text(size) + " pixels";
  if (first.x + first.y + first.z != 0 || part.x != size.x || part.y != size.y || part.z != size.z)
    return "holds only " + text(part) + " of its " + text(size) + " pixels";
  const std::size_t pixels = size.x * size.y;
  if (content.size() - kPixels != pixels * components * each)
    return "has " + std::to_string(content.size() - kPixels) + " bytes for " + text(size) + " pixels of " +
           std::to_string(components * each);

  ReceivedImage image;
  const auto number = [&](std::size_t i) {
    return double(std::bit_cast<float>(number_at<std::uint32_t>(content.data() + 12 + 4 * i, false)));
  };
  glm::dmat4& place = image.frame_from_pixel;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) place[column][row] = number(std::size_t(3 * column + row));
  // The protocol places the centre of the image.
  const glm::dvec3 corner = glm::dvec3(place[3]) - (double(size.x) - 1) / 2 * glm::dvec3(place[0]) -
                            (double(size.y) - 1) / 2 * glm::dvec3(place[1]);
  place[3] = glm::dvec4(corner, 1);

  image.grey = Image<std::uint8_t>(int(size.x), int(size.y));
  const auto value = [&](std::size_t i) {
    const std::uint8_t* at = content.data() + kPixels + i * components * each;
    double grey = value_at(at, type, little);
    if (components > 1)
      grey = 0.299 * grey + 0.587 * value_at(at + each, type, little) + 0.114 * value_at(at + 2 * each, type, little);
    return std::isfinite(grey) ? std::max(grey, 0.0) : 0;
  };
  double scale = 1;
  if (type != kUint8) {
    double most = 0;
    for (std::size_t i = 0; i < pixels; ++i) most = std::max(most, value(i));
    scale = most > 0 ? 255 / most : 0;
  }
  for (std::size_t i = 0; i < pixels; ++i)
    image.grey.pixels[i] = std::uint8_t(std::lround(std::min(scale * value(i), 255.0)));
  return image;
}

}  // namespace insonate::igtl
