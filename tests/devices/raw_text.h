#pragma once

#include <charconv>
#include <cstdint>
#include <span>
#include <string>

namespace insonate {

/// Returns bytes as a raw recording writes them.
inline std::string hex(std::span<const std::uint8_t> bytes) {
  std::string digits;
  for (const std::uint8_t byte : bytes) {
    digits += "0123456789abcdef"[byte >> 4];
    digits += "0123456789abcdef"[byte & 15];
  }
  return digits;
}

/// Returns a time as a raw recording writes it.
inline std::string shortest(double number) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, number).ptr};
}

/// Returns the first lines of a raw recording of an OpenIGTLink connection that was made at `time_s`.
inline std::string raw_igtl_head(const std::string& uri, double time_s) {
  return "insonate raw 1\ntracker " + uri + "\nstart 1 0 0 0 1 0 0 0 1 0 0 0\nopen " + shortest(time_s) +
         " 0000:0000\n";
}

}  // namespace insonate
