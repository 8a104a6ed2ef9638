// Clutter: the scatterers' mean echo over a plane's lines at each depth, sum of T S / lines, with WAVES of the scattered
// power. Side lobes bring a share of it to every line (clutter_share(), sim/model/noise.h). With WAVES also E, the mean
// echo of layers, which wall_clutter.comp takes.
//
// Reads the echoes of the beam's stage and, with WAVES, the scan. Writes the mean echo, E and J.
// Dispatch: samples x planes invocations, in work groups of GROUP x 1. An invocation takes one sample and loops over
// the lines, because neighbouring samples are neighbours in memory.

layout(local_size_x = GROUP) in;

#include "shared/simulation_parameters.h"
#include "shared/model_constants.h"

layout(binding = 0) uniform samplerBuffer echoes;  // one row per line: R, T, S, V; with WAVES f, I^2, V
layout(binding = 1) uniform samplerBuffer scan;    // with WAVES, one row per line: I, scattered power, e (re, im)
layout(std430, binding = 0) writeonly buffer MeanEcho { vec4 mean_echo[]; };     // one row per plane: mean, 0, J
layout(std430, binding = 1) writeonly buffer LayerEcho { float layer_echo[]; };  // one row per plane: E

void main() {
  int k = int(gl_GlobalInvocationID.x), plane = int(gl_GlobalInvocationID.y);
  if (k >= samples) return;
  float sum = 0.0, of_layers = 0.0, arriving = 0.0;
  for (int line = 0; line < lines; ++line) {
    int at = (plane * lines + line) * samples + k;
    vec4 value = texelFetch(echoes, at);
#if WAVES == 1
    sum += texelFetch(scan, at).y;
    arriving += value.z;
    of_layers += min(dot(value.xy, value.xy), kLayerShare * value.z);
#else
    sum += value.y * value.z;
#endif
  }
  mean_echo[plane * samples + k] = vec4(sum, 0.0, arriving, 0.0) / float(lines);
#if WAVES == 1
  layer_echo[plane * samples + k] = max(of_layers / float(lines) - kMinLayerEcho, 0.0);
#endif
}
