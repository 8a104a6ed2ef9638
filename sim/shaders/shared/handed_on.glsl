// How what one stage hands to the next is kept: as floats, or in half as many bits. I, R and what follows from them span
// more decades than half floats do, so their fourth roots are kept: 6e-5, below which half floats lose digits, is that of
// 1e-17. What is kept as it is ends at the largest half float. sim/gl/handed_on.cpp reads the same.
//
// A stage reads a texel as the buffer's format gives it, as floats in both.

#include "shared/least_echo.glsl"

const float kLeastIntensity = 1e-15;  // whose square is kLeastEcho

#if HALF_FLOATS == 1
#define HANDED_4 uvec2
#define HANDED_2 uint
const float kMostHalf = 65504.0;
vec2 fourth_root(vec2 value) { return sqrt(sqrt(value)); }
vec2 fourth_power(vec2 root) {
  vec2 squared = root * root;
  return squared * squared;
}

// I, R, and a complex amplitude; of the former two alone.
uint kept_energy(vec2 energy) { return packHalf2x16(fourth_root(energy)); }
vec2 energy_of(vec2 texel) { return fourth_power(texel); }
uvec2 kept_scan(vec4 scan) {
  return uvec2(kept_energy(scan.xy), packHalf2x16(clamp(scan.zw, -kMostHalf, kMostHalf)));
}
vec4 scan_of(uvec2 kept) { return vec4(energy_of(unpackHalf2x16(kept.x)), unpackHalf2x16(kept.y)); }
vec4 scan_of(vec4 texel) { return vec4(energy_of(texel.xy), texel.zw); }

// R, T, S, V.
uvec2 kept_echo(vec4 echo) {
  vec2 repeated = vec2(min(echo.z, kMostHalf), fourth_root(echo.ww).x);
  return uvec2(kept_energy(echo.xy), packHalf2x16(repeated));
}
vec4 echo_of(vec4 texel) { return vec4(energy_of(texel.xy), texel.z, fourth_power(texel.ww).x); }

// X, S.
uint kept_pixel(vec2 pixel) { return packHalf2x16(vec2(fourth_root(pixel.xx).x, min(pixel.y, kMostHalf))); }
vec2 pixel_of(vec2 texel) { return vec2(fourth_power(texel.xx).x, texel.y); }
#else
#define HANDED_4 vec4
#define HANDED_2 vec2
vec2 kept_energy(vec2 energy) { return energy; }
vec2 energy_of(vec2 texel) { return texel; }
vec4 kept_scan(vec4 scan) { return scan; }
vec4 scan_of(vec4 kept) { return kept; }
vec4 kept_echo(vec4 echo) { return echo; }
vec4 echo_of(vec4 texel) { return texel; }
vec2 kept_pixel(vec2 pixel) { return pixel; }
vec2 pixel_of(vec2 texel) { return texel; }
#endif
