// Fusion of a sweep, (6) of Kutter, Shams, Navab 2009, on its lines:
//
//     U = (R + b T) S + V + noise
//
// A volume is not smoothed as a picture is, so fusion need not follow scan conversion.
//
// Reads the echoes, the noise and the mean echo. Writes U.
// Dispatch: samples x lines x planes invocations, one per sample, in work groups of 64 x 1 x 1.

layout(local_size_x = 64) in;

#include "shared/simulation_parameters.h"

layout(binding = 0) uniform samplerBuffer echoes;     // one row per line, plane by plane: R, T, S, V
layout(binding = 1) uniform samplerBuffer noise;      // one row per line of a plane, with mean 1
layout(binding = 2) uniform samplerBuffer mean_echo;  // one row per plane: mean of T S over the lines, with its tail
layout(std430, binding = 0) writeonly buffer Fused { float fused[]; };  // U, in the order of `echoes`

void main() {
  int k = int(gl_GlobalInvocationID.x), line = int(gl_GlobalInvocationID.y), plane = int(gl_GlobalInvocationID.z);
  if (k >= samples) return;
  int at = (plane * lines + line) * samples + k;
  vec4 value = texelFetch(echoes, at);
  float echo = (value.x + blend * value.y) * value.z + value.w;
#if NOISE == 1
  int noise_line = (line + (first_plane + plane) * noise_step) % lines;
  float mean = noise_level;
#if CLUTTER == 1
  mean += clutter_share * blend * texelFetch(mean_echo, plane * samples + k).x;
#endif
  echo += mean * texelFetch(noise, noise_line * samples + k).x;
#endif
  fused[at] = echo;
}
