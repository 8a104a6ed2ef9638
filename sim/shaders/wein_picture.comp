// Scan conversion of a chunk's images, each into its tile of the grid: a work group takes a run of the fan's pixels, an
// invocation four neighbours at once, which it stores as one.

layout(local_size_x = GROUP) in;

#include "shared/wein_parameters.h"
#include "shared/wein_scan.glsl"

layout(std430, binding = 0) writeonly buffer Grid { uint grid[]; };  // four pixels each, row by row

float grey_of(ivec4 pixel, int image) {
  vec2 terms = terms_at(pixel, image);
  return pixel.x < 0 ? 0.0 : mix(terms.x, terms.y, reflection_share);
}

void main() {
  int image = int(gl_WorkGroupID.y), tile = first + image, row_words = columns * tile_words;
  int corner = tile / columns * tile_height * row_words + tile % columns * tile_words;
  int count = steps();
  for (int i = 0; i < count; i += 4) {
    ivec4 pixel = pixel_at(i);  // tells for all four where they go: words, rows
    vec4 greys = vec4(grey_of(pixel, image), grey_of(pixel_at(i + 1), image), grey_of(pixel_at(i + 2), image),
                      grey_of(pixel_at(i + 3), image));
    if (pixel.w >= 0) grid[corner + (pixel.w >> 16) * row_words + (pixel.w & 0xffff)] = packUnorm4x8(greys);
  }
}
