// Scan conversion of a chunk's images, each into its tile of the grid: a work group takes a run of the fan's pixels.

layout(local_size_x = 8) in;

#include "shared/wein_parameters.h"

layout(binding = 0) uniform sampler2DArray scan;
layout(binding = 1) uniform sampler2D pixels;  // where in the scan, x, y; a column an invocation
layout(binding = 0, r8) writeonly uniform image2D grid;

void main() {
  int column = int(gl_GlobalInvocationID.x), image = int(gl_WorkGroupID.y), tile = first + image;
  ivec2 corner = ivec2(tile % columns, tile / columns) * ivec2(width, height);
  int steps = textureSize(pixels, 0).y;
  for (int i = 0; i < steps; ++i) {
    vec4 pixel = texelFetch(pixels, ivec2(column, i), 0);
    vec2 terms = textureLod(scan, vec3(pixel.xy, float(image)), 0.0).xy;
    imageStore(grid, corner + ivec2(pixel.zw), vec4(mix(terms.x, terms.y, reflection_share)));
  }
}
