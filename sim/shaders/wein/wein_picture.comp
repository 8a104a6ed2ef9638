// Scan conversion of model W: converts each image of a chunk into its tile of the grid.
//
// Reads the scan and the table of pixels. Writes the grid.
// Dispatch: columns of the pixel table x runs of IMAGES_PER_INVOCATION images, in work groups of GROUP x 1. A work group takes
// a run of the fan's pixels. An invocation converts four neighbouring pixels and stores them as one word. It converts
// the images of its run one after the other.

layout(local_size_x = GROUP) in;

#include "wein/wein_parameters.h"
#include "wein/wein_scan.glsl"

layout(std430, binding = 0) writeonly buffer Grid { uint grid[]; };  // four pixels each, row by row

// Returns the grey levels of the images that share a texel; 0 outside the fan.
vec4 greys_of(ivec4 pixel, int image_group) { return pixel.x < 0 ? vec4(0.0) : scanned_at(pixel, image_group); }

void main() {
  int first_image = int(gl_WorkGroupID.y) * IMAGES_PER_INVOCATION, end = min(first_image + IMAGES_PER_INVOCATION, images);
  ivec2 first_tile = ivec2((first + first_image) % columns, (first + first_image) / columns);
  int row_words = columns * tile_words, count = steps();
  for (int i = 0; i < count; i += 4) {
    ivec4 a = pixel_at(i), b = pixel_at(i + 1), c = pixel_at(i + 2), d = pixel_at(i + 3);
    int in_tile = (a.w >> 16) * row_words + (a.w & 0xffff);  // offset of all four in the tile, in words
    ivec2 tile = first_tile;
    for (int image = first_image; image < end; image += interleaved_greys) {
      int group = image / interleaved_greys;
      mat4 by_pixel = mat4(greys_of(a, group), greys_of(b, group), greys_of(c, group), greys_of(d, group)),
           by_image = transpose(by_pixel);
      for (int j = 0; j < interleaved_greys; ++j) {
        if (a.w >= 0 && image + j < end)
          grid[tile.y * tile_height * row_words + tile.x * tile_words + in_tile] = packUnorm4x8(by_image[j]);
        tile = tile.x + 1 < columns ? ivec2(tile.x + 1, tile.y) : ivec2(0, tile.y + 1);
      }
    }
  }
}
