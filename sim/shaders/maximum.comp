// The brightest pixel after gain, in decibels, a column an invocation: gains may reach beyond single precision's range,
// their decibels do not.

layout(local_size_x = 16) in;

#include "shared/simulation_parameters.h"
#include "shared/time_gain.glsl"

layout(binding = 0) uniform sampler2D fused;
layout(binding = 1) uniform sampler2D line_and_sample;
layout(std430, binding = 0) buffer Maximum { uint maximum_bits; };  // as ordered() gives it, 0 while there is none

// Whole numbers in the order of the floats.
uint ordered(float value) {
  uint bits = floatBitsToUint(value);
  return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

void main() {
  int x = int(gl_GlobalInvocationID.x);
  if (x >= width) return;
  uint brightest = 0u;
  for (int y = 0; y < height; ++y) {
    float echo = texelFetch(fused, ivec2(x, y), 0).x;
    if (echo > 0.0) {
      float gain_db = time_gain_db(texelFetch(line_and_sample, ivec2(x, y), 0).y);
      brightest = max(brightest, ordered(4.342944819 * log(echo) + gain_db));
    }
  }
  atomicMax(maximum_bits, brightest);
}
