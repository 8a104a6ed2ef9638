// Fusion of a sweep, (6) of Kutter, Shams, Navab 2009, on its lines:
//
//     U = (R + b T) S + V + noise,  with WAVES U = |f + d + noise|^2 + V (sim/model/waves.h)
//
// A volume is not smoothed as a picture is, so fusion need not follow scan conversion.
//
// Reads the echoes, the noise and the mean echo. Writes U.
// Dispatch: samples x lines x planes invocations, one per sample, in work groups of 64 x 1 x 1.

layout(local_size_x = 64) in;

#include "shared/simulation_parameters.h"
#include "shared/least_echo.glsl"

layout(binding = 0) uniform samplerBuffer echoes;     // one row per line, plane by plane: R, T, S, V; with WAVES f, I^2, V
layout(binding = 1) uniform samplerBuffer noise;      // one row per line of a plane, with mean 1; with WAVES complex
layout(binding = 2) uniform samplerBuffer mean_echo;  // one row per plane: mean echo over the lines, with its tail, H, H/J
layout(std430, binding = 0) writeonly buffer Fused { float fused[]; };  // U, in the order of `echoes`

void main() {
  int k = int(gl_GlobalInvocationID.x), line = int(gl_GlobalInvocationID.y), plane = int(gl_GlobalInvocationID.z);
  if (k >= samples) return;
  int at = (plane * lines + line) * samples + k;
  vec4 value = texelFetch(echoes, at);
  float echo = (value.x + blend * value.y) * value.z + value.w;
  vec2 wave = value.xy;
#if NOISE == 1
  int noise_line = (line + (first_plane + plane) * noise_step) % lines;
  float mean = noise_level;
#if CLUTTER == 1
  vec4 clutter = texelFetch(mean_echo, plane * samples + k);
  mean += clutter_share * (WAVES == 1 ? 1.0 : blend) * clutter.x + min(clutter.y, clutter.z * value.z);
#endif
  vec2 of_receiver = texelFetch(noise, noise_line * samples + k).xy;
  echo += mean * of_receiver.x;
  wave += sqrt(mean) * of_receiver;
#endif
  if (WAVES == 1) {
    if (ring_down > 0.0) wave.x += ring_down * exp(-ring_down_per_sample * (float(k) + 0.5));
    echo = dot(wave, wave) + value.w;
    if (echo <= kMinEcho) echo = 0.0;
  }
  fused[at] = echo;
}
