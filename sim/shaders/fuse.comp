// Fusion (6): reflected and scattered echo, both through the speckle.

layout(local_size_x = 16, local_size_y = 4) in;

#include "shared/simulation_parameters.h"

layout(binding = 0) uniform sampler2D picture;
layout(binding = 0, r32f) writeonly uniform image2D fused;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(fused)))) return;
  vec4 value = texelFetch(picture, pixel, 0);
  imageStore(fused, pixel, vec4((value.x + blend * value.y) * value.z));
}
