// The brightest pixel after gain, a column an invocation. Floats that are not negative order as their bits do.

layout(local_size_x = 16) in;

#include "shared/simulation_parameters.h"
#include "shared/time_gain.glsl"

layout(binding = 0) uniform sampler2D fused;
layout(binding = 1) uniform sampler2D line_and_sample;
layout(std430, binding = 5) buffer Maximum { uint maximum_bits; };

void main() {
  int x = int(gl_GlobalInvocationID.x);
  ivec2 size = textureSize(fused, 0);
  if (x >= size.x) return;
  float brightest = 0.0;
  for (int y = 0; y < size.y; ++y) {
    vec2 position = texelFetch(line_and_sample, ivec2(x, y), 0).xy;
    if (position.x > -1.0) brightest = max(brightest, texelFetch(fused, ivec2(x, y), 0).x * time_gain(position.y));
  }
  atomicMax(maximum_bits, floatBitsToUint(brightest));
}
