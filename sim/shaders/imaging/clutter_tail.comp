// Tail of the clutter: what the side lobes bring late. The mean echo m of each depth fades exponentially into the
// depths behind it (clutter_share(), sim/model/noise.h):
//
//     M(k + 1) = m(k + 1) + (M(k) - m(k + 1)) e^(-dr/kClutterTail_mm),  M(0) = m(0)
//
// Reads the mean echo of clutter.comp and replaces it.
// Dispatch: one invocation per plane, in work groups of 1. It loops over the plane's samples, a few hundred steps.

layout(local_size_x = 1) in;

#include "shared/simulation_parameters.h"

layout(std430, binding = 0) buffer MeanEcho { vec4 mean_echo[]; };  // one row per plane: mean of T S, tail added; two of the
                                                           // body wall

void main() {
  int row = int(gl_GlobalInvocationID.x) * samples;
  float mean = mean_echo[row].x;
  for (int k = row + 1; k < row + samples; ++k) {
    mean = mix(mean_echo[k].x, mean, clutter_kept);
    mean_echo[k].x = mean;
  }
}
