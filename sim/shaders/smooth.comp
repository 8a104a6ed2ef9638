// The Gaussians G_s1 and G_s2 of (6) along the rows of the picture; along its columns they run where R and T are fused.
// Pixels outside the fan are 0 and stay so.
//
// An invocation serves four pixels of a row, whose windows overlap: a value is read once for all four.

layout(local_size_x = 8, local_size_y = 8) in;

#include "shared/simulation_parameters.h"
#include "shared/fan_blocks.glsl"
#include "shared/gaussian.glsl"

layout(binding = 0) uniform sampler2D picture;  // R, T, S, V; 0, 0, 0, -1 outside the fan
layout(binding = 0, rg32f) writeonly uniform image2D half_smoothed;  // R, T

// At the distance j from the first of the four pixels: R, T, and whether it lies inside the fan.
vec3 texel(ivec2 first, int j) {
  vec4 value = texelFetch(picture, ivec2(clamp(first.x + j, 0, width - 1), first.y), 0);
  bool exists = first.x + j >= 0 && first.x + j < width;
  return exists && value.w >= 0.0 ? vec3(value.xy, 1.0) : vec3(0.0);
}

void main() {
  ivec2 first = first_of_row();
  if (first.x >= width || first.y >= height) return;

  vec4 reflection = vec4(0.0), transmission = vec4(0.0), weights = vec4(0.0);
  for (int j = -REFLECTION_RADIUS; j <= REFLECTION_RADIUS + 3; ++j) {
    weights = vec4(gaussian(j, REFLECTION_RADIUS, reflection_exponent_px), weights.xyz);
    reflection += weights * texel(first, j).x;
  }
  weights = vec4(0.0);
  for (int j = -TRANSMISSION_RADIUS; j <= TRANSMISSION_RADIUS + 3; ++j) {
    weights = vec4(gaussian(j, TRANSMISSION_RADIUS, transmission_exponent_px), weights.xyz);
    transmission += weights * texel(first, j).y;
  }
  for (int i = 0; i < 4; ++i)
    if (first.x + i < width) {
      float inside = texel(first, i).z;
      imageStore(half_smoothed, first + ivec2(i, 0), vec4(reflection[i] * inside, transmission[i] * inside, 0.0, 0.0));
    }
}
