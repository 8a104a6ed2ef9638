// The Gaussians G_s1 and G_s2 of (6) along the rows of the picture; along its columns they run where R and T are fused.
// Beside each sum goes what of its window lies inside the fan, by which the sum is divided in the end. Pixels outside the
// fan are 0 and stay so.
//
// An invocation serves four pixels of a row, whose windows overlap: a value is read once for all four.

layout(local_size_x = 8, local_size_y = 8) in;

#include "shared/simulation_parameters.h"
#include "shared/fan_blocks.glsl"
#include "shared/gaussian.glsl"

layout(binding = 0) uniform sampler2D picture;       // R, X, S, sample + 1; 0 outside the fan
layout(binding = 1) uniform sampler2D transmission;  // T
layout(binding = 0, SUMS_FORMAT) writeonly uniform image2D half_smoothed;  // of R: sum, weight; of T: sum, weight

// At the distance j from the first of the four pixels: where to read, R there, and whether it lies inside the fan.
ivec2 place(ivec2 first, int j) { return ivec2(clamp(first.x + j, 0, width - 1), first.y); }
vec2 reflection_at(ivec2 first, int j) {
  vec4 value = texelFetch(picture, place(first, j), 0);
  bool exists = first.x + j >= 0 && first.x + j < width;
  return exists && value.w > 0.0 ? vec2(value.x, 1.0) : vec2(0.0);
}

void main() {
  ivec2 first = first_of_row();
  if (first.x >= width || first.y >= height) return;

  vec4 reflection = vec4(0.0), reflection_weight = vec4(0.0), weights = vec4(0.0);
  for (int j = -REFLECTION_RADIUS; j <= REFLECTION_RADIUS + 3; ++j) {
    weights = vec4(gaussian(j, REFLECTION_RADIUS, reflection_exponent_px), weights.xyz);
    vec2 value = reflection_at(first, j);
    reflection += weights * value.x;
    reflection_weight += weights * value.y;
  }
  vec4 transmitted = vec4(0.0), transmitted_weight = vec4(0.0);
#if TRANSMISSION_RADIUS > 0
  weights = vec4(0.0);
  for (int j = -TRANSMISSION_RADIUS; j <= TRANSMISSION_RADIUS + 3; ++j) {
    weights = vec4(gaussian(j, TRANSMISSION_RADIUS, transmission_exponent_px), weights.xyz);
    float inside = reflection_at(first, j).y;
    transmitted += weights * inside * texelFetch(transmission, place(first, j), 0).x;
    transmitted_weight += weights * inside;
  }
#endif
  for (int i = 0; i < 4; ++i)
    if (first.x + i < width)
      imageStore(half_smoothed, first + ivec2(i, 0),
                 reflection_at(first, i).y * vec4(reflection[i], reflection_weight[i], transmitted[i], transmitted_weight[i]));
}
