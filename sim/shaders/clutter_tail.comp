// What the side lobes bring late: the mean echo of each depth fades exponentially into those behind it. One invocation
// goes down the samples, some hundred steps.

layout(local_size_x = 1) in;

#include "shared/simulation_parameters.h"

layout(binding = 0, r32f) uniform image2D mean_echo;  // a sample: mean of T S, and with its tail

void main() {
  float mean = imageLoad(mean_echo, ivec2(0)).x;
  for (int k = 1; k < samples; ++k) {
    mean = mix(imageLoad(mean_echo, ivec2(k, 0)).x, mean, clutter_kept);
    imageStore(mean_echo, ivec2(k, 0), vec4(mean));
  }
}
