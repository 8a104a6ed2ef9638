// Fusion, (6) of Kutter, Shams, Navab 2009: reflected and scattered echo, both multiplied by the speckle,
//
//     U = X + S (G_s1 R + b G_s2 T),  X as in scan_convert.comp
//
// If R and T are to be smoothed, smooth.comp has smoothed them along the rows. This stage smooths along the columns. If
// white is a fixed level, it goes on to grey (7). If each frame sets its own white, it stores the levels and the
// brightest level of its block. X is the part of U that is not smoothed.
//
// Reads X and S, the half-smoothed R and T, and the table of the fan. Writes the image or what shared/show.glsl keeps;
// with FRAME_MAXIMUM, the levels instead; with KEEP_FUSED also U.
// Dispatch: one work group of 64 x 1 per block of the fan (shared/fan_blocks.glsl). An invocation serves four pixels of
// a column. Their windows overlap, so it reads each value once for all four.

layout(local_size_x = 64, local_size_y = 1) in;

#include "shared/simulation_parameters.h"
#include "shared/fan_blocks.glsl"
#include "shared/gaussian.glsl"
#include "shared/grey.glsl"
#include "shared/time_gain.glsl"

layout(binding = 0) uniform samplerBuffer picture;        // X, S; with LOOKS above 1, U^(1/2) of one look after the
                                                          // other, below 0 where its lines do not reach
layout(binding = 1) uniform samplerBuffer half_smoothed;  // sums of R's and T's windows along the rows
layout(binding = 2) uniform samplerBuffer fan;            // per pixel: x: index of the sample + 1, or 0 outside the fan;
                                                          // y, z: 1 / sum of the weights of R's and T's windows in it
#if KEEP_FUSED == 1
layout(std430, binding = 1) writeonly buffer Fused { float fused[]; };  // U
#endif
#if FRAME_MAXIMUM == 1
layout(std430, binding = 2) writeonly buffer Levels { float levels[]; };  // U after the gains, dB
layout(std430, binding = 0) buffer Brightest { uint brightest[]; };  // per block, as ordered() encodes it; 0 for none
#else
#include "shared/show.glsl"
#endif

vec2 half_smoothed_at(ivec2 at) {
  vec2 value = texelFetch(half_smoothed, index_of(ivec2(at.x, clamp(at.y, 0, height - 1)))).xy;
  return at.y >= 0 && at.y < height ? value : vec2(0.0);
}

// Returns X and S; of several looks, their mean of sim/model/compounding.h and 0.
vec2 picture_at(int pixel) {
#if LOOKS > 1
  float sum = 0.0, count = 0.0;
  for (int look = 0; look < LOOKS; ++look) {
    float amplitude = texelFetch(picture, look * width * height + pixel).x;
    sum += max(amplitude, 0.0);
    count += amplitude >= 0.0 ? 1.0 : 0.0;
  }
  float mean = sum / max(count, 1.0);
  return vec2(mean * mean, 0.0);
#else
  return texelFetch(picture, pixel).xy;
#endif
}

void main() {
  ivec2 first = first_of_column();
  if (first.x >= width || first.y >= height) return;

  vec4 reflection = vec4(0.0), transmission = vec4(0.0), weights = vec4(0.0);
#if REFLECTION_RADIUS > 0
  for (int j = -REFLECTION_RADIUS; j <= REFLECTION_RADIUS + 3; ++j) {
    weights = vec4(gaussian(j, REFLECTION_RADIUS, reflection_exponent_px), weights.xyz);
    reflection += weights * half_smoothed_at(first + ivec2(0, j)).x;
  }
#endif
#if TRANSMISSION_RADIUS > 0
  weights = vec4(0.0);
  for (int j = -TRANSMISSION_RADIUS; j <= TRANSMISSION_RADIUS + 3; ++j) {
    weights = vec4(gaussian(j, TRANSMISSION_RADIUS, transmission_exponent_px), weights.xyz);
    transmission += weights * half_smoothed_at(first + ivec2(0, j)).y;
  }
#endif

  uint brightest_here = 0u;
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = first + ivec2(0, i);
    if (pixel.y >= height) break;
    vec2 value = picture_at(index_of(pixel));
    vec3 place = texelFetch(fan, index_of(pixel)).xyz;
    bool inside = place.x > 0.0;
    float smoothed = reflection[i] * place.y + blend * transmission[i] * place.z;
    float echo = inside ? value.x + value.y * smoothed : 0.0;
    float level = inside ? level_db(echo) + gain_at_db((place.x - 0.5) / float(samples)) : kOutsideFan;
#if KEEP_FUSED == 1
    fused[index_of(pixel)] = echo;
#endif
#if FRAME_MAXIMUM == 1
    levels[index_of(pixel)] = level;
    if (inside) brightest_here = max(brightest_here, ordered(level));
#else
    show(index_of(pixel), level, level_db(fixed_level));
#endif
  }
#if FRAME_MAXIMUM == 1
  atomicMax(brightest[block()], brightest_here);
#endif
}
