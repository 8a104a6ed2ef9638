// Smoothing: the Gaussians G_s1 and G_s2 of the fusion, (6) of Kutter, Shams, Navab 2009, along the rows of the
// picture. fuse.comp smooths along the columns and divides by the part of the window that lies inside the fan. Pixels
// outside the fan add nothing and stay 0.
//
// Reads R and T of scan_convert.comp. Writes the sums of their windows.
// Dispatch: one work group of 16 x 4 per block of the fan (shared/fan_blocks.glsl). An invocation serves four pixels of
// a row. Their windows overlap, so it reads each value once for all four.

layout(local_size_x = 16, local_size_y = 4) in;

#include "shared/simulation_parameters.h"
#include "shared/fan_blocks.glsl"
#include "shared/gaussian.glsl"

layout(binding = 0) uniform samplerBuffer sharp;                                          // R, T; -1 outside the fan
layout(std430, binding = 0) writeonly buffer HalfSmoothed { SMOOTHED half_smoothed[]; };  // sums of R's and T's windows

// Returns R and T at distance j from the first of the four pixels; -1 outside the fan.
vec2 sharp_at(ivec2 first, int j) {
  int x = first.x + j;
  vec2 value = texelFetch(sharp, index_of(ivec2(clamp(x, 0, width - 1), first.y))).xy;
  return x >= 0 && x < width ? value : vec2(-1.0);
}

void main() {
  ivec2 first = first_of_row();
  if (first.x >= width || first.y >= height) return;

  vec4 reflection = vec4(0.0), transmission = vec4(0.0), weights = vec4(0.0);
  for (int j = -REFLECTION_RADIUS; j <= REFLECTION_RADIUS + 3; ++j) {
    weights = vec4(gaussian(j, REFLECTION_RADIUS, reflection_exponent_px), weights.xyz);
    reflection += weights * max(sharp_at(first, j).x, 0.0);
  }
#if TRANSMISSION_RADIUS > 0
  weights = vec4(0.0);
  for (int j = -TRANSMISSION_RADIUS; j <= TRANSMISSION_RADIUS + 3; ++j) {
    weights = vec4(gaussian(j, TRANSMISSION_RADIUS, transmission_exponent_px), weights.xyz);
    transmission += weights * max(sharp_at(first, j).y, 0.0);
  }
#endif
  for (int i = 0; i < 4; ++i) {
    vec2 sums = sharp_at(first, i).x >= 0.0 ? vec2(reflection[i], transmission[i]) : vec2(0.0);
    if (first.x + i < width) half_smoothed[index_of(first) + i] = SMOOTHED(sums);
  }
}
