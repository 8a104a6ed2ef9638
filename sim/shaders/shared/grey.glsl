// From level to grey: log compression (7) and the grey map GREY_MAP, a compile-time constant.

#include "shared/least_echo.glsl"

const float kSilent = -1e30;       // level of a pixel without echo
const float kOutsideFan = 1e30;    // level of a pixel outside the fan

// In decibels, because gains may exceed the range of single precision and their decibels do not.
float level_db(float echo) { return echo > kMinEcho ? 4.342944819 * log(echo) : kSilent; }

// Exponents and curve are those of GreyMap (sim/model/settings.h).
float mapped(float g) {
  if (GREY_MAP == 1) return pow(g, 0.75);
  if (GREY_MAP == 2) return pow(g, 1.5);
  if (GREY_MAP == 3) return g * g * (3.0 - 2.0 * g);
  return g;
}

// Returns the compressed echo (7) before the grey map, 0 to 1.
float compressed(float level, float white_db) {
  return level > kSilent ? 1.0 - clamp((white_db - level) / dynamic_range_db, 0.0, 1.0) : 0.0;
}

// The same number whether bytes are stored as red, green, blue or as blue, green, red.
uint pixel_of(float echo) { return packUnorm4x8(vec4(vec3(mapped(echo)), 1.0)); }

// Maps a level to an unsigned number that sorts in the same order, so that atomicMax() finds the brightest.
uint ordered(float level) {
  uint bits = floatBitsToUint(level);
  return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

float level_of(uint in_order) {
  return uintBitsToFloat((in_order & 0x80000000u) == 0u ? ~in_order : in_order & 0x7fffffffu);
}
