// The whole volume view, one ray per invocation: for graphics cards, the largest of which draw fragments on a few of their
// processors only.
//
// Reads what view/volume_ray.glsl lists. Writes the colours. Dispatch: a group for each 8 x 8 pixels of the rows from
// first_row to end_row.
layout(local_size_x = 8, local_size_y = 8) in;

#include "view/whole_ray.glsl"

layout(std430, binding = 0) writeonly buffer Picture { uint colours[]; };  // packed, rows of the whole picture

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, first_row);
  if (pixel.x >= int(picture.x) || pixel.y >= end_row) return;
  colours[pixel.y * int(picture.x) + pixel.x] = packUnorm4x8(colour_of(pixel));
}
