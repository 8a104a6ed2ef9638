// The display filter of sim/model/display_filter.h: edge enhancement and speckle reduction, then the grey map.
//
// Reads the compressed echo g and the sums of enhance_rows.comp. Writes the image.
// Dispatch: one work group of 64 x 1 per block of the fan (shared/fan_blocks.glsl). An invocation serves four pixels of
// a column. Their windows overlap, so it reads each value once for all four.

layout(local_size_x = 64, local_size_y = 1) in;

#include "shared/simulation_parameters.h"
#include "shared/fan_blocks.glsl"
#include "shared/gaussian.glsl"
#include "shared/grey.glsl"

layout(binding = 0) uniform samplerBuffer shown;  // 1 + g; 0 outside the fan
layout(binding = 1) uniform samplerBuffer sums;   // of 1, g, g^2 along the rows
layout(std430, binding = 3) writeonly buffer Image { uint image[]; };  // grey, grey, grey, 1 inside the fan; packed

vec3 sums_at(ivec2 at) {
  vec3 value = texelFetch(sums, index_of(ivec2(at.x, clamp(at.y, 0, height - 1)))).xyz;
  return at.y >= 0 && at.y < height ? value : vec3(0.0);
}

void main() {
  ivec2 first = first_of_column();
  if (first.x >= width || first.y >= height) return;

  vec4 ones = vec4(0.0), echoes = vec4(0.0), squares = vec4(0.0), weights = vec4(0.0);
  for (int j = -RADIUS; j <= RADIUS + 3; ++j) {
    weights = vec4(gaussian(j, RADIUS, filter_exponent_px), weights.xyz);
    vec3 here = sums_at(first + ivec2(0, j));
    ones += weights * here.x;
    echoes += weights * here.y;
    squares += weights * here.z;
  }
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = first + ivec2(0, i);
    if (pixel.y >= height) break;
    float kept = texelFetch(shown, index_of(pixel)).x, g = kept - 1.0;
    float mean = echoes[i] / max(ones[i], 1e-30), variance = squares[i] / max(ones[i], 1e-30) - mean * mean;
    float share = variance > speckle_variance ? speckle_variance / variance : 1.0;
    float factor = edge_enhancement * (1.0 - share) - speckle_reduction * share;
    image[index_of(pixel)] = kept > 0.0 ? pixel_of(clamp(g + factor * (g - mean), 0.0, 1.0)) : 0u;
  }
}
