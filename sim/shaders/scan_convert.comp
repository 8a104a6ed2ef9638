// Backward warp from the lines to the picture, bilinear. Where each pixel lies among the lines is worked out once per
// probe and depth, so this stage knows no probe.

layout(local_size_x = 32, local_size_y = 2) in;

#include "shared/simulation_parameters.h"
#include "shared/fan_blocks.glsl"

layout(binding = 0) uniform sampler2D echoes;           // a row a line: R, T, S, V
layout(binding = 1) uniform sampler2D line_and_sample;  // per pixel; line below -1 outside the fan
layout(binding = 0, rgba32f) writeonly uniform image2D picture;  // R, T, S, V; 0, 0, 0, -1 outside the fan

void convert(ivec2 pixel) {
  vec2 position = texelFetch(line_and_sample, pixel, 0).xy;
  bool inside = position.x > -1.0;
  ivec2 last = ivec2(samples, lines) - 1;
  position = clamp(position.yx, vec2(0.0), vec2(last));
  ivec2 low = min(ivec2(position), max(last - 1, 0)), high = min(low + 1, last);
  vec2 f = position - vec2(low);
  vec4 value = mix(mix(texelFetch(echoes, low, 0), texelFetch(echoes, ivec2(high.x, low.y), 0), f.x),
                   mix(texelFetch(echoes, ivec2(low.x, high.y), 0), texelFetch(echoes, high, 0), f.x), f.y);
  imageStore(picture, pixel, inside ? value : vec4(0.0, 0.0, 0.0, -1.0));
}

void main() {
  ivec2 first = first_of_column();
  for (int i = 0; i < 4; ++i)
    if (first.x < width && first.y + i < height) convert(first + ivec2(0, i));
}
