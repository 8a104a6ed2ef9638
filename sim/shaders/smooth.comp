// The Gaussians G_s1 and G_s2 of (6) along the rows of the picture; along its columns they run where R and T are fused.
// Pixels outside the fan are 0 and stay so.
//
// An invocation serves four pixels of a row, whose windows overlap: a value is read once for all four.

layout(local_size_x = 8, local_size_y = 8) in;

#include "shared/simulation_parameters.h"
#include "shared/fan_blocks.glsl"

layout(binding = 0) uniform sampler2D picture;  // R, T, S, V; 0, 0, 0, -1 outside the fan
layout(std430, binding = 0) readonly buffer ReflectionWindow { vec4 reflection_window[]; };  // by place from the first
layout(std430, binding = 1) readonly buffer TransmissionWindow { vec4 transmission_window[]; };  // pixel's edge
layout(binding = 0, rg32f) writeonly uniform image2D half_smoothed;                               // R, T

vec4 texel(ivec2 at) {
  return at.x >= 0 && at.x < width ? texelFetch(picture, at, 0) : vec4(0.0);
}

void main() {
  ivec2 first = block_start() + ivec2(4, 1) * ivec2(gl_LocalInvocationID.xy);
  if (first.x >= width || first.y >= height) return;

  vec4 own[4];
  for (int i = 0; i < 4; ++i) own[i] = texel(first + ivec2(i, 0));
  vec4 reflection = vec4(own[0].x, own[1].x, own[2].x, own[3].x);
  vec4 transmission = vec4(own[0].y, own[1].y, own[2].y, own[3].y);
  if (reflection_radius_px > 0) {
    reflection = vec4(0.0);
    for (int j = -reflection_radius_px; j <= reflection_radius_px + 3; ++j)
      reflection += reflection_window[j + reflection_radius_px] * texel(first + ivec2(j, 0)).x;
  }
  if (transmission_radius_px > 0) {
    transmission = vec4(0.0);
    for (int j = -transmission_radius_px; j <= transmission_radius_px + 3; ++j)
      transmission += transmission_window[j + transmission_radius_px] * texel(first + ivec2(j, 0)).y;
  }
  for (int i = 0; i < 4; ++i)
    if (first.x + i < width)
      imageStore(half_smoothed, first + ivec2(i, 0), vec4(own[i].w < 0.0 ? vec2(0.0) : vec2(reflection[i], transmission[i]), 0.0, 0.0));
}
