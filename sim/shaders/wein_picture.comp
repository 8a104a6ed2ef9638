// Scan conversion of a chunk's images, each into its tile of the grid: an invocation a row of an image, which keeps to
// the pixels that the fan touches there.

layout(local_size_x = 8) in;

#include "shared/wein_parameters.h"
#include "shared/wein_scan.glsl"

layout(binding = 1) uniform sampler2D pixels;  // line, sample; line below -1 outside the fan
layout(std430, binding = 0) readonly buffer Rows { ivec2 in_fan[]; };  // a row: first pixel inside, behind the last
layout(binding = 0, r8) writeonly uniform image2D grid;

void main() {
  int index = int(gl_GlobalInvocationID.x);
  if (index >= height * images) return;
  int y = index % height, image = index / height, tile = first + image;
  ivec2 range = in_fan[y], corner = ivec2(tile % columns, tile / columns) * ivec2(width, height) + ivec2(0, y);
  for (int x = range.x; x < range.y; ++x) {
    vec2 at = texelFetch(pixels, ivec2(x, y), 0).xy;
    vec2 terms = terms_at(at, image);
    float inside = at.x > -1.0 ? 1.0 : 0.0;
    imageStore(grid, corner + ivec2(x, 0), vec4(inside * mix(terms.x, terms.y, reflection_share)));
  }
}
