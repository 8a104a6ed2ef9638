// Log compression, (7) of Kutter, Shams, Navab 2009, where each frame's brightest pixel is white:
//
//     grey = m(clamp(1 - (white_db - level) / dynamic_range_db, 0, 1)),  m the grey map
//
// fuse.comp does this where white is a fixed level.
//
// Reads the levels of fuse.comp and their maximum. Writes the image or what shared/show.glsl keeps.
// Dispatch: one work group of 64 x 1 per block of the fan (shared/fan_blocks.glsl). An invocation serves four pixels of
// a column.

layout(local_size_x = 64, local_size_y = 1) in;

#include "shared/simulation_parameters.h"
#include "shared/fan_blocks.glsl"
#include "shared/grey.glsl"
#include "shared/show.glsl"

layout(binding = 0) uniform samplerBuffer levels;                       // U after the gains, dB
layout(std430, binding = 0) readonly buffer Maximum { uint maximum; };  // as ordered() encodes it

void main() {
  ivec2 first = first_of_column();
  float white_db = level_of(maximum);
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = first + ivec2(0, i);
    if (pixel.x < width && pixel.y < height)
      show(index_of(pixel), texelFetch(levels, index_of(pixel)).x, white_db);
  }
}
