// The pulse of sim/model/waves.h: convolves the echo along each line with the pulse's envelope.
//
// Reads the scan of the traversal. Writes the echo behind the pulse.
// Dispatch: samples / 4 x lines of all planes invocations, in work groups of 64 x 1. An invocation serves four
// neighbouring samples. Their windows overlap, so it reads each value once for all four.

layout(local_size_x = 64) in;

#include "shared/simulation_parameters.h"

layout(binding = 0) uniform samplerBuffer scan;                    // one row per line: I, scattered power, echo (re, im)
layout(std430, binding = 0) writeonly buffer Pulsed { vec2 pulsed[]; };  // one row per line: re, im

void main() {
  int first = 4 * int(gl_GlobalInvocationID.x), line = int(gl_GlobalInvocationID.y), row = line * samples;
  if (first >= samples) return;

  vec4 re = vec4(0.0), im = vec4(0.0), weights = vec4(0.0);
  float sum = 0.0;
  for (int j = -PULSE_RADIUS; j <= PULSE_RADIUS + 3; ++j) {
    float weight = j <= PULSE_RADIUS ? exp(pulse_exponent * float(j * j)) : 0.0;
    sum += weight;
    weights = vec4(weight, weights.xyz);
    int k = first + j;
    vec2 echo = texelFetch(scan, row + clamp(k, 0, samples - 1)).zw;
    if (k < 0 || k >= samples) echo = vec2(0.0);
    re += weights * echo.x;
    im += weights * echo.y;
  }
  for (int i = 0; i < 4; ++i)
    if (first + i < samples) pulsed[row + first + i] = vec2(re[i], im[i]) / sum;
}
