// Gain, log compression (7) and the grey scale.

layout(local_size_x = 32, local_size_y = 8) in;

#include "shared/simulation_parameters.h"
#include "shared/time_gain.glsl"
#include "shared/fan_blocks.glsl"

layout(binding = 0) uniform sampler2D fused;
layout(binding = 1) uniform sampler2D line_and_sample;
layout(std430, binding = 0) readonly buffer Maximum { uint maximum_bits; };
layout(binding = 0, rgba8) writeonly uniform image2D image;  // grey, grey, grey, 1 inside the fan

// Exponents and curve as GreyMap says.
float mapped(float g) {
  if (grey_map == 1) return pow(g, 0.75);
  if (grey_map == 2) return pow(g, 1.5);
  if (grey_map == 3) return g * g * (3.0 - 2.0 * g);
  return g;
}

// As maximum.comp has written it.
float maximum_db() {
  bool negative = (maximum_bits & 0x80000000u) == 0u;
  return uintBitsToFloat(negative ? ~maximum_bits : maximum_bits & 0x7fffffffu);
}

void main() {
  ivec2 pixel = block_start() + ivec2(gl_LocalInvocationID.xy);
  if (pixel.x >= width || pixel.y >= height) return;
  vec2 position = texelFetch(line_and_sample, pixel, 0).xy;
  float white_db = frame_maximum == 1 ? maximum_db() : 4.342944819 * log(fixed_level);
  float echo = texelFetch(fused, pixel, 0).x;
  float grey = 0.0;  // also for a frame without any echo, whose maximum is 0
  if (echo > 0.0)
    grey = 1.0 - clamp((white_db - 4.342944819 * log(echo) - time_gain_db(position.y)) / dynamic_range_db, 0.0, 1.0);
  imageStore(image, pixel, position.x > -1.0 ? vec4(vec3(mapped(grey)), 1.0) : vec4(0.0));
}
