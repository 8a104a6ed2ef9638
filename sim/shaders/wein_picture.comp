// Scan conversion of a chunk's images, each into its tile of the grid: a work group a block of pixels that the fan
// touches, and an image.

layout(local_size_x = 32, local_size_y = 8) in;

#include "shared/wein_parameters.h"
#include "shared/wein_scan.glsl"
#include "shared/fan_blocks.glsl"

layout(binding = 1) uniform sampler2D pixels;  // line, sample; line below -1 outside the fan
layout(binding = 0, r8) writeonly uniform image2D grid;

void main() {
  ivec2 pixel = block_start() + ivec2(gl_LocalInvocationID.xy);
  int image = int(gl_WorkGroupID.y);
  vec4 at = texelFetch(pixels, min(pixel, ivec2(width, height) - 1), 0);
  if (pixel.x >= width || pixel.y >= height || at.x <= -1.0) return;
  vec2 terms = terms_at(at.xy, image);
  int tile = first + image;
  ivec2 corner = ivec2(tile % columns, tile / columns) * ivec2(width, height);
  imageStore(grid, corner + pixel, vec4(mix(terms.x, terms.y, reflection_share)));
}
