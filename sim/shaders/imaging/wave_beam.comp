// The beam of sim/model/waves.h: sums of the echo's amplitudes across the lines of the active aperture, and of V,
//
//     f(i) = sum_j w(j) echo(i + j),  sum_j w(j) = 1
//
// At the array's ends, the part of the aperture that is missing sends and receives nothing.
//
// Reads the echo behind the pulse, the table by depth, the scan and, with REVERBERATION, V. Writes f, I^2 and V.
// Dispatch: samples x lines / 4 x planes invocations, in work groups of 64 x 1 x 1. An invocation computes one sample
// of four neighbouring lines. Their apertures overlap, so it reads each value once for all four.

layout(local_size_x = 64) in;

#include "shared/simulation_parameters.h"

layout(binding = 0) uniform samplerBuffer pulsed;    // one row per line: re, im
layout(binding = 1) uniform samplerBuffer at_depth;  // per sample: 1 / the sum of the weights, radius of the focused
                                                     // beam in lines, exponent of its Gaussian
layout(binding = 2) uniform samplerBuffer repeats;   // one row per line: V before the window, with REVERBERATION
layout(binding = 3) uniform samplerBuffer scan;      // one row per line: I, scattered power, e (re, im)
layout(std430, binding = 0) writeonly buffer Echoes { vec4 echoes[]; };  // one row per line: f (re, im), I^2, V

#include "shared/aperture.glsl"

vec4 re = vec4(0.0), im = vec4(0.0), repeated = vec4(0.0);
int plane_row;             // index of the plane's first sample
vec4 weights = vec4(0.0);  // of the line that is being added, for each of the four lines

// Adds line first + j. Each call must take the line behind the previous call's line, because `weights` moves on by one
// line per call.
void add(int first, int j, int k) {
  weights = vec4(weight_at(j), weights.xyz);
  int at = first + j, place = plane_row + clamp(at, 0, lines - 1) * samples + k;
  vec4 weight = at >= 0 && at < lines ? weights : vec4(0.0);
  vec2 echo = texelFetch(pulsed, place).xy;
  re += weight * echo.x;
  im += weight * echo.y;
#if REVERBERATION == 1
  repeated += weight * texelFetch(repeats, place).x;
#endif
}

void main() {
  int k = int(gl_GlobalInvocationID.x), first = 4 * int(gl_GlobalInvocationID.y);
  if (first >= lines || k >= samples) return;
  plane_row = int(gl_GlobalInvocationID.z) * lines * samples;

  vec4 here = texelFetch(at_depth, k);
  place_aperture(here);
  for (int j = -radius; j <= radius + 3; ++j) add(first, j, k);
  for (int i = 0; i < 4; ++i)
    if (first + i < lines) {
      int at = plane_row + (first + i) * samples + k;
      float arriving = texelFetch(scan, at).x;
      echoes[at] = vec4(vec3(re[i], im[i], repeated[i]) * here.x, arriving * arriving).xywz;
    }
}
