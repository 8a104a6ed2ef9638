// Fusion (6): reflected and scattered echo, both through the speckle. Where R and T are smoothed, smooth.comp has done so
// along the rows; here follow the columns.
//
// An invocation serves four pixels of a column, whose windows overlap: a value is read once for all four. Where white
// is a fixed level it goes on to grey; where each frame sets its own, to the brightest level of its block.

layout(local_size_x = 64, local_size_y = 1) in;

#include "shared/simulation_parameters.h"
#include "shared/fan_blocks.glsl"
#include "shared/gaussian.glsl"
#include "shared/grey.glsl"
#include "shared/time_gain.glsl"

layout(binding = 0) uniform samplerBuffer picture;        // X, S
layout(binding = 1) uniform samplerBuffer half_smoothed;  // of R, T: the sums of their windows along the rows
layout(binding = 2) uniform samplerBuffer fan;            // per pixel: sample + 1, or 0 outside; of R's and of T's
                                                          // window, 1 / its sum
#if KEEP_FUSED == 1
layout(std430, binding = 1) writeonly buffer Fused { float fused[]; };  // U
#endif
#if FRAME_MAXIMUM == 1
layout(std430, binding = 2) writeonly buffer Levels { float levels[]; };  // of U behind the gains, dB
layout(std430, binding = 0) buffer Brightest { uint brightest[]; };  // a block, as ordered() gives it; 0 for none
#else
layout(binding = 1, r32ui) writeonly uniform uimage2D image;  // grey, grey, grey, 1 inside the fan; packed
#endif

vec2 half_smoothed_at(ivec2 at) {
  vec2 value = texelFetch(half_smoothed, index_of(ivec2(at.x, clamp(at.y, 0, height - 1)))).xy;
  return at.y >= 0 && at.y < height ? value : vec2(0.0);
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
    vec2 value = texelFetch(picture, index_of(pixel)).xy;
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
    imageStore(image, pixel, uvec4(grey_pixel(level, level_db(fixed_level))));
#endif
  }
#if FRAME_MAXIMUM == 1
  atomicMax(brightest[block()], brightest_here);
#endif
}
