// Scan conversion of a chunk's images, each into its tile of the grid: a work group takes a run of the fan's pixels, an
// invocation four neighbours at once, which it stores as one, of several images one after the other.

layout(local_size_x = GROUP) in;

#include "shared/wein_parameters.h"
#include "shared/wein_scan.glsl"

layout(std430, binding = 0) writeonly buffer Grid { uint grid[]; };  // four pixels each, row by row

float grey_of(ivec4 pixel, int image) { return pixel.x < 0 ? 0.0 : scanned_at(pixel, image).x; }

void main() {
  int first_image = int(gl_WorkGroupID.y) * IMAGES_IN_TURN, end = min(first_image + IMAGES_IN_TURN, images);
  ivec2 first_tile = ivec2((first + first_image) % columns, (first + first_image) / columns);
  int row_words = columns * tile_words, count = steps();
  for (int i = 0; i < count; i += 4) {
    ivec4 a = pixel_at(i), b = pixel_at(i + 1), c = pixel_at(i + 2), d = pixel_at(i + 3);
    int in_tile = (a.w >> 16) * row_words + (a.w & 0xffff);  // for all four
    ivec2 tile = first_tile;
    for (int image = first_image; image < end; ++image) {
      vec4 greys = vec4(grey_of(a, image), grey_of(b, image), grey_of(c, image), grey_of(d, image));
      if (a.w >= 0) grid[tile.y * tile_height * row_words + tile.x * tile_words + in_tile] = packUnorm4x8(greys);
      tile = tile.x + 1 < columns ? ivec2(tile.x + 1, tile.y) : ivec2(0, tile.y + 1);
    }
  }
}
