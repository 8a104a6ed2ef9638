// One direction of the separable Gaussians G_s1 and G_s2 of (6), over the pixels inside the fan alone.

layout(local_size_x = 16, local_size_y = 4) in;

#include "shared/simulation_parameters.h"

layout(binding = 0) uniform sampler2D picture;
layout(std430, binding = 4) readonly buffer Kernels { float kernel[]; };  // half of s1's, then half of s2's, centre first
layout(binding = 0, rgba32f) writeonly uniform image2D smoothed;
layout(location = 0) uniform ivec2 axis;

// (sum of weighted values, sum of weights); a pixel outside the fan has no weight.
vec2 gathered(ivec2 pixel, int radius, int first, int channel) {
  vec2 sum = vec2(0.0);
  ivec2 size = textureSize(picture, 0);
  for (int j = -radius; j <= radius; ++j) {
    ivec2 at = pixel + j * axis;
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) continue;
    vec4 value = texelFetch(picture, at, 0);
    sum += kernel[first + abs(j)] * value.w * vec2(value[channel], 1.0);
  }
  return sum;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(smoothed)))) return;
  vec4 value = texelFetch(picture, pixel, 0);
  if (value.w > 0.0) {
    if (reflection_radius_px > 0) {
      vec2 sum = gathered(pixel, reflection_radius_px, 0, 0);
      value.x = sum.x / sum.y;
    }
    if (transmission_radius_px > 0) {
      vec2 sum = gathered(pixel, transmission_radius_px, reflection_radius_px + 1, 1);
      value.y = sum.x / sum.y;
    }
  }
  imageStore(smoothed, pixel, value);
}
