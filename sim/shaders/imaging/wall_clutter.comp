// Clutter from the body wall: H of sim/model/noise.h, the echo of layers convolved with itself.
//
// Reads E and J of clutter.comp. Writes H, and H/J in the place of J.
// Dispatch: samples x planes invocations, in work groups of GROUP x 1. An invocation takes one sample and loops over
// the samples in front of it.

layout(local_size_x = GROUP) in;

#include "shared/simulation_parameters.h"
#include "shared/model_constants.h"

layout(binding = 0) uniform samplerBuffer layer_echo;  // one row per plane: E
layout(std430, binding = 0) buffer MeanEcho { vec4 mean_echo[]; };  // one row per plane: mean of T S, H, H/J

void main() {
  int k = int(gl_GlobalInvocationID.x), row = int(gl_GlobalInvocationID.y) * samples;
  if (k >= samples) return;
  float sum = 0.0;
  for (int i = 0; i < k; ++i)
    sum += texelFetch(layer_echo, row + i).x *
           (texelFetch(layer_echo, row + k - i).x + texelFetch(layer_echo, row + k - 1 - i).x);
  sum += texelFetch(layer_echo, row + k).x * texelFetch(layer_echo, row).x;
  float arriving = mean_echo[row + k].z, clutter = kWallReturn * reflection_exponent * 0.5 * sum;
  mean_echo[row + k].yz = arriving > kMinEcho ? vec2(clutter, clutter / arriving) : vec2(0.0);
}
