#pragma once

#include "devices/bytes.h"

namespace insonate {

/// Returns the CRC-16 with polynomial 0x1021, most significant bit first, neither reflected nor inverted. `start` is
/// the initial value of the register. With 0 it is the CRC that catalogues call XMODEM ("123456789" gives 0x31c3).
constexpr std::uint16_t crc16_1021(Bytes bytes, std::uint16_t start) {
  std::uint16_t crc = start;
  for (const std::uint8_t byte : bytes) {
    crc = std::uint16_t(crc ^ byte << 8);
    for (int bit = 0; bit < 8; ++bit) crc = std::uint16_t(crc & 0x8000 ? crc << 1 ^ 0x1021 : crc << 1);
  }
  return crc;
}

/// Returns the CRC-16/ARC: polynomial 0x8005, least significant bit first, initial value 0 ("123456789" gives 0xbb3d).
constexpr std::uint16_t crc16_arc(Bytes bytes) {
  std::uint16_t crc = 0;
  for (const std::uint8_t byte : bytes) {
    crc = std::uint16_t(crc ^ byte);
    for (int bit = 0; bit < 8; ++bit) crc = std::uint16_t(crc & 1 ? crc >> 1 ^ 0xa001 : crc >> 1);
  }
  return crc;
}

}  // namespace insonate
