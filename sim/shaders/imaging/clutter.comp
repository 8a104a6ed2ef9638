// Clutter: the scatterers' mean echo over a plane's lines at each depth, sum of T S / lines, with WAVES of the scattered
// power. Side lobes bring a share of it to every line (clutter_share(), sim/model/noise.h).
//
// Reads the echoes of the beam's stage or, with WAVES, the scan. Writes the mean echo.
// Dispatch: samples x planes invocations, in work groups of GROUP x 1. An invocation takes one sample and loops over
// the lines, because neighbouring samples are neighbours in memory.

layout(local_size_x = GROUP) in;

#include "shared/simulation_parameters.h"

layout(binding = 0) uniform samplerBuffer echoes;  // one row per line: R, T, S, V; with WAVES the scan, scattered power
                                                   // second
layout(std430, binding = 0) writeonly buffer MeanEcho { float mean_echo[]; };  // one row per plane

void main() {
  int k = int(gl_GlobalInvocationID.x), plane = int(gl_GlobalInvocationID.y);
  if (k >= samples) return;
  float sum = 0.0;
  for (int line = 0; line < lines; ++line) {
    vec4 value = texelFetch(echoes, (plane * lines + line) * samples + k);
    sum += WAVES == 1 ? value.y : value.y * value.z;
  }
  mean_echo[plane * samples + k] = sum / float(lines);
}
