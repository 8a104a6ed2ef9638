// Fusion (6): reflected and scattered echo, both through the speckle. Where R and T are smoothed, smooth.comp has done so
// along the rows; here follow the columns.
//
// An invocation serves four pixels of a column, whose windows overlap: a value is read once for all four. Where white
// is a fixed level it goes on to grey; where each frame sets its own, to the brightest level of its block.

layout(local_size_x = 32, local_size_y = 2) in;

#include "shared/simulation_parameters.h"
#include "shared/fan_blocks.glsl"
#include "shared/gaussian.glsl"
#include "shared/grey.glsl"

layout(binding = 0) uniform sampler2D picture;        // R, X, S, sample + 1; 0 outside the fan
layout(binding = 1) uniform sampler2D half_smoothed;  // of R: sum, weight; of T: sum, weight
layout(binding = 0, rg32f) writeonly uniform image2D fused;  // U, its level in dB
#if FRAME_MAXIMUM == 1
layout(std430, binding = 0) buffer Brightest { uint brightest[]; };  // a block, as ordered() gives it; 0 for none
#else
layout(binding = 1, rgba8) writeonly uniform image2D image;
#endif

vec4 half_smoothed_at(ivec2 at) {
  return at.y >= 0 && at.y < height ? texelFetch(half_smoothed, at, 0) : vec4(0.0);
}

void main() {
  ivec2 first = first_of_column();
  if (first.x >= width || first.y >= height) return;

  vec4 smoothed = vec4(0.0);  // R + b T of the four pixels
#if REFLECTION_RADIUS > 0
  vec4 reflection = vec4(0.0), reflection_weight = vec4(0.0), of_reflection = vec4(0.0);
  for (int j = -REFLECTION_RADIUS; j <= REFLECTION_RADIUS + 3; ++j) {
    of_reflection = vec4(gaussian(j, REFLECTION_RADIUS, reflection_exponent_px), of_reflection.xyz);
    vec4 value = half_smoothed_at(first + ivec2(0, j));
    reflection += of_reflection * value.x;
    reflection_weight += of_reflection * value.y;
  }
  smoothed += reflection / reflection_weight;
#endif
#if TRANSMISSION_RADIUS > 0
  vec4 transmission = vec4(0.0), transmission_weight = vec4(0.0), of_transmission = vec4(0.0);
  for (int j = -TRANSMISSION_RADIUS; j <= TRANSMISSION_RADIUS + 3; ++j) {
    of_transmission = vec4(gaussian(j, TRANSMISSION_RADIUS, transmission_exponent_px), of_transmission.xyz);
    vec4 value = half_smoothed_at(first + ivec2(0, j));
    transmission += of_transmission * value.z;
    transmission_weight += of_transmission * value.w;
  }
  smoothed += blend * (transmission / transmission_weight);
#endif

  uint brightest_here = 0u;
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = first + ivec2(0, i);
    if (pixel.y >= height) break;
    vec4 value = texelFetch(picture, pixel, 0);
    bool inside = value.w > 0.0;
    float echo = inside ? value.y + value.z * smoothed[i] : 0.0;
    float level = inside ? level_db(echo) + time_gain_db(value.w - 1.0) : kOutsideFan;
#if KEEP_FUSED == 1
    imageStore(fused, pixel, vec4(echo, level, 0.0, 0.0));
#endif
#if FRAME_MAXIMUM == 1
    if (inside) brightest_here = max(brightest_here, ordered(level));
#else
    imageStore(image, pixel, grey_pixel(level, level_db(fixed_level)));
#endif
  }
#if FRAME_MAXIMUM == 1
  atomicMax(brightest[gl_WorkGroupID.x], brightest_here);
#endif
}
