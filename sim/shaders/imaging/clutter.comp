// The scatterers' mean echo over a plane's lines at each depth, of which side lobes bring a share to every line. Neighbouring
// samples are neighbours in memory, so an invocation takes a sample and goes through the lines.

layout(local_size_x = GROUP) in;

#include "shared/simulation_parameters.h"

layout(binding = 0) uniform samplerBuffer echoes;                             // a row a line: R, T, S, V
layout(std430, binding = 0) writeonly buffer MeanEcho { float mean_echo[]; };  // a row a plane: mean of T S

void main() {
  int k = int(gl_GlobalInvocationID.x), plane = int(gl_GlobalInvocationID.y);
  if (k >= samples) return;
  float sum = 0.0;
  for (int line = 0; line < lines; ++line) {
    vec4 value = texelFetch(echoes, (plane * lines + line) * samples + k);
    sum += value.y * value.z;
  }
  mean_echo[plane * samples + k] = sum / float(lines);
}
