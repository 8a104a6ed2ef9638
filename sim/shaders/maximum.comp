// The brightest pixel after gain, a column an invocation. Floats that are not negative order as their bits do.

layout(local_size_x = 16) in;

#include "shared/simulation_parameters.h"
#include "shared/time_gain.glsl"

layout(binding = 0) uniform sampler2D fused;
layout(binding = 1) uniform sampler2D line_and_sample;
layout(std430, binding = 0) buffer Maximum { uint maximum_bits; };

void main() {
  int x = int(gl_GlobalInvocationID.x);
  if (x >= width) return;
  float brightest = 0.0;
  for (int y = 0; y < height; ++y) {
    float echo = texelFetch(fused, ivec2(x, y), 0).x;
    if (echo > 0.0) brightest = max(brightest, echo * exp(0.2302585093 * time_gain_db(texelFetch(line_and_sample, ivec2(x, y), 0).y)));
  }
  atomicMax(maximum_bits, floatBitsToUint(brightest));
}
