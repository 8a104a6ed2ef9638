#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace insonate {

using Bytes = std::span<const std::uint8_t>;

// The functions read the little-endian number at byte `offset`. The caller has checked that `bytes` is long enough.

constexpr std::uint16_t u16_at(Bytes bytes, std::size_t offset) {
  return std::uint16_t(bytes[offset] | bytes[offset + 1] << 8);
}

constexpr std::int16_t i16_at(Bytes bytes, std::size_t offset) {
  return std::int16_t(u16_at(bytes, offset));
}

constexpr std::uint32_t u32_at(Bytes bytes, std::size_t offset) {
  return u16_at(bytes, offset) | std::uint32_t(u16_at(bytes, offset + 2)) << 16;
}

constexpr float f32_at(Bytes bytes, std::size_t offset) {
  return std::bit_cast<float>(u32_at(bytes, offset));
}

}  // namespace insonate
