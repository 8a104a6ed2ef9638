#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace insonate {

/// The type of one number in an image file: of a voxel, or of a pixel's channel.
enum class ElementType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// Returns the type's name: "int16".
std::string to_string(ElementType type);

/// Returns the bytes of one number.
std::size_t bytes_of(ElementType type);

/// Returns the number whose bytes begin at `bytes`, which needs no alignment.
template <typename Number>
Number number_at(const void* bytes, bool big_endian) {
  std::array<std::byte, sizeof(Number)> ordered;
  std::memcpy(ordered.data(), bytes, sizeof(Number));
  if (big_endian != (std::endian::native == std::endian::big)) std::reverse(ordered.begin(), ordered.end());
  return std::bit_cast<Number>(ordered);
}

/// Calls `use` with a zero of the C++ type that has these numbers, and returns its result.
template <typename Use>
auto with_type(ElementType type, Use use) {
  switch (type) {
    case ElementType::int8:
      return use(std::int8_t{});
    case ElementType::uint8:
      return use(std::uint8_t{});
    case ElementType::int16:
      return use(std::int16_t{});
    case ElementType::uint16:
      return use(std::uint16_t{});
    case ElementType::int32:
      return use(std::int32_t{});
    case ElementType::uint32:
      return use(std::uint32_t{});
    case ElementType::int64:
      return use(std::int64_t{});
    case ElementType::uint64:
      return use(std::uint64_t{});
    case ElementType::float32:
      return use(float{});
    case ElementType::float64:
      break;
  }
  return use(double{});
}

}  // namespace insonate
