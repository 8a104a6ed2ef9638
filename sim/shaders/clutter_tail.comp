// What the side lobes bring late: the mean echo of each depth fades exponentially into those behind it. One invocation
// goes down the samples, some hundred steps.

layout(local_size_x = 1) in;

#include "shared/simulation_parameters.h"

layout(std430, binding = 0) buffer MeanEcho { float mean_echo[]; };  // a sample: mean of T S, and with its tail

void main() {
  float mean = mean_echo[0];
  for (int k = 1; k < samples; ++k) {
    mean = mix(mean_echo[k], mean, clutter_kept);
    mean_echo[k] = mean;
  }
}
