// The window of the display filter (sim/model/display_filter.h) along the rows of the picture.
//
// Reads the compressed echo g. Writes the window's sums of 1, g and g^2 over the pixels inside the fan.
// Dispatch: one work group of 16 x 4 per block of the fan (shared/fan_blocks.glsl). An invocation serves four pixels of
// a row. Their windows overlap, so it reads each value once for all four.

layout(local_size_x = 16, local_size_y = 4) in;

#include "shared/simulation_parameters.h"
#include "shared/fan_blocks.glsl"
#include "shared/gaussian.glsl"

layout(binding = 0) uniform samplerBuffer shown;                    // 1 + g; 0 outside the fan
layout(std430, binding = 0) writeonly buffer Sums { vec4 sums[]; };  // of 1, g, g^2; 0 outside the fan

// Returns what is kept at distance j from the first of the four pixels.
float shown_at(ivec2 first, int j) {
  int x = first.x + j;
  float value = texelFetch(shown, index_of(ivec2(clamp(x, 0, width - 1), first.y))).x;
  return x >= 0 && x < width ? value : 0.0;
}

void main() {
  ivec2 first = first_of_row();
  if (first.x >= width || first.y >= height) return;

  vec4 ones = vec4(0.0), echoes = vec4(0.0), squares = vec4(0.0), weights = vec4(0.0);
  for (int j = -RADIUS; j <= RADIUS + 3; ++j) {
    weights = vec4(gaussian(j, RADIUS, filter_exponent_px), weights.xyz);
    float value = shown_at(first, j), inside = value > 0.0 ? 1.0 : 0.0, g = inside * (value - 1.0);
    ones += weights * inside;
    echoes += weights * g;
    squares += weights * (g * g);
  }
  for (int i = 0; i < 4; ++i)
    if (first.x + i < width)
      sums[index_of(first) + i] = shown_at(first, i) > 0.0 ? vec4(ones[i], echoes[i], squares[i], 0.0) : vec4(0.0);
}
