#pragma once

#include <cstdint>

namespace insonate {

inline constexpr std::uint32_t kHashFirst = 0x85ebca6bu, kHashSecond = 0xc2b2ae35u;  ///< multipliers of a round
inline constexpr std::uint32_t kHashNext = 0x9e3779b9u;                              ///< added between rounds

/// Returns a counter-based random number: the same key gives the same 32 well-mixed bits on every machine, in any order
/// and from any thread. Uses the mixing steps of MurmurHash3's 32-bit finaliser (Appleby, public domain), one round per
/// key.
constexpr std::uint32_t hash(std::uint32_t h) {
  h ^= h >> 16;
  h *= kHashFirst;
  h ^= h >> 13;
  h *= kHashSecond;
  h ^= h >> 16;
  return h;
}

constexpr std::uint32_t hash(std::uint32_t a, std::uint32_t b) {
  return hash(hash(a) + kHashNext + b);
}

constexpr std::uint32_t hash(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  return hash(hash(hash(a, b), c), d);
}

/// Maps 32 random bits to [0, 1). Uses 24 of them, which a float holds exactly.
constexpr float unit_float(std::uint32_t bits) {
  return float(bits >> 8) * (1.0f / 16777216.0f);
}

}  // namespace insonate
