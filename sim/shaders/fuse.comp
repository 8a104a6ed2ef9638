// Fusion (6): reflected and scattered echo, both through the speckle, and with them clutter and the receiver's noise.
// Where R and T are smoothed, smooth.comp has done so along the rows; here follow the columns, and the division by the
// part of the windows that lies inside the fan.
//
// An invocation serves four pixels of a column, whose windows overlap: a value is read once for all four. Where white
// is a fixed level it goes on to grey; where each frame sets its own, to the brightest level of its block.

layout(local_size_x = 32, local_size_y = 2) in;

#include "shared/simulation_parameters.h"
#include "shared/fan_blocks.glsl"
#include "shared/gaussian.glsl"
#include "shared/grey.glsl"

layout(binding = 0) uniform sampler2D picture;        // R, T, S, V; 0, 0, 0, -1 outside the fan
layout(binding = 1) uniform sampler2D half_smoothed;  // R, T
// 1 / (what of the two windows lies inside), noise of mean 1, sample
layout(binding = 2) uniform sampler2D pixel_constants;
layout(binding = 3) uniform sampler2D mean_echo;            // a sample: mean of T S over the lines
layout(binding = 0, rg32f) writeonly uniform image2D fused;  // U, its level in dB
#if FRAME_MAXIMUM == 1
layout(std430, binding = 0) buffer Brightest { uint brightest[]; };  // a block, as ordered() gives it; 0 for none
#else
layout(binding = 1, rgba8) writeonly uniform image2D image;
#endif

vec2 half_smoothed_at(ivec2 at) {
  return at.y >= 0 && at.y < height ? texelFetch(half_smoothed, at, 0).xy : vec2(0.0);
}

// Its mean at a place along the lines: of the electronics, and with CLUTTER what the side lobes bring.
float noise_at(float sample_position) {
#if CLUTTER == 1
  float position = clamp(sample_position, 0.0, float(samples - 1));
  int low = int(position), high = min(low + 1, samples - 1);
  float mean = mix(texelFetch(mean_echo, ivec2(low, 0), 0).x, texelFetch(mean_echo, ivec2(high, 0), 0).x,
                  position - float(low));
  return noise_level + clutter_share * blend * mean;
#else
  return noise_level;
#endif
}

void main() {
  ivec2 first = first_of_column();
  if (first.x >= width || first.y >= height) return;

  vec4 reflection = vec4(0.0), transmission = vec4(0.0), weights = vec4(0.0);
  if (REFLECTION_RADIUS > 0)
    for (int j = -REFLECTION_RADIUS; j <= REFLECTION_RADIUS + 3; ++j) {
      weights = vec4(gaussian(j, REFLECTION_RADIUS, reflection_exponent_px), weights.xyz);
      reflection += weights * half_smoothed_at(first + ivec2(0, j)).x;
    }
  weights = vec4(0.0);
  if (TRANSMISSION_RADIUS > 0)
    for (int j = -TRANSMISSION_RADIUS; j <= TRANSMISSION_RADIUS + 3; ++j) {
      weights = vec4(gaussian(j, TRANSMISSION_RADIUS, transmission_exponent_px), weights.xyz);
      transmission += weights * half_smoothed_at(first + ivec2(0, j)).y;
    }

  uint brightest_here = 0u;
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = first + ivec2(0, i);
    if (pixel.y >= height) break;
    vec4 value = texelFetch(picture, pixel, 0);
    vec4 constants = texelFetch(pixel_constants, pixel, 0);
    if (REFLECTION_RADIUS > 0) value.x = reflection[i] * constants.x;
    if (TRANSMISSION_RADIUS > 0) value.y = transmission[i] * constants.y;
    float echo = (value.x + blend * value.y) * value.z + value.w + noise_at(constants.w) * constants.z;
    bool inside = value.w >= 0.0;
    float level = inside ? level_db(echo) + time_gain_db(constants.w) : kOutsideFan;
    imageStore(fused, pixel, vec4(echo, level, 0.0, 0.0));
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
