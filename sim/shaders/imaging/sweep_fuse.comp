// Fusion (6) of a sweep, on its lines: a volume is not smoothed as a picture is, so there is nothing to wait for.

layout(local_size_x = 64) in;

#include "shared/simulation_parameters.h"

layout(binding = 0) uniform samplerBuffer echoes;     // a row a line, plane by plane: R, T, S, V
layout(binding = 1) uniform samplerBuffer noise;      // a row a line of a plane, of mean 1
layout(binding = 2) uniform samplerBuffer mean_echo;  // a row a plane: mean of T S over the lines, with its tail
layout(std430, binding = 0) writeonly buffer Fused { float fused[]; };  // as echoes: U

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
