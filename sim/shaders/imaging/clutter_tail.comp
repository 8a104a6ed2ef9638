// What the side lobes bring late: the mean echo of each depth fades exponentially into those behind it. An
// invocation goes down the samples of a plane, some hundred steps.

layout(local_size_x = 1) in;

#include "shared/simulation_parameters.h"

layout(std430, binding = 0) buffer MeanEcho { float mean_echo[]; };  // a row a plane: mean of T S, and with its tail

void main() {
  int row = int(gl_GlobalInvocationID.x) * samples;
  float mean = mean_echo[row];
  for (int k = row + 1; k < row + samples; ++k) {
    mean = mix(mean_echo[k], mean, clutter_kept);
    mean_echo[k] = mean;
  }
}
