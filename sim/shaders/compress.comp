// Log compression (7) where each frame's brightest pixel is white; fuse.comp does it where white is a fixed level.

layout(local_size_x = 32, local_size_y = 2) in;

#include "shared/simulation_parameters.h"
#include "shared/fan_blocks.glsl"
#include "shared/grey.glsl"

layout(binding = 0) uniform sampler2D fused;                           // U, its level in dB
layout(std430, binding = 0) readonly buffer Maximum { uint maximum; };  // as ordered() gives it
layout(binding = 0, rgba8) writeonly uniform image2D image;            // grey, grey, grey, 1 inside the fan

void main() {
  ivec2 first = first_of_column();
  float white_db = level_of(maximum);
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = first + ivec2(0, i);
    if (pixel.x < width && pixel.y < height)
      imageStore(image, pixel, grey_pixel(texelFetch(fused, pixel, 0).y, white_db));
  }
}
