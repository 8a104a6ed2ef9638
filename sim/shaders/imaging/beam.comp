// Beam width, (4) of Kutter, Shams, Navab 2009: weighted means across the lines of the active aperture,
//
//     R(i) = sum_j w(j) R(i + j) / sum_j w(j),  V alike
//     S(i) = scale |sum_j w(j) echo(i + j)| / sum_j w(j)
//
// With STORED_SPECKLE, S is that of the sample, from a scattering volume (sim/model/stored_speckle.h).
//
// Scatterers add up as complex amplitudes before their envelope is taken, which is what makes speckle. Only lines of
// the same plane count: the first line of the next plane lies at the array's other end.
//
// Reads the scan of the traversal, the tables by depth, the window and, with REVERBERATION, V. Writes R, T, S, V.
// Dispatch: samples x lines / 4 x planes invocations, in work groups of 64 x 1 x 1. An invocation computes one sample
// of four neighbouring lines. Their apertures overlap, so it reads each value once for all four.

layout(local_size_x = 64) in;

#include "shared/simulation_parameters.h"
#include "shared/least_echo.glsl"

layout(binding = 0) uniform samplerBuffer scan;      // one row per line: I, R, scatterers' echo (re, im)
layout(binding = 1) uniform samplerBuffer at_depth;  // per sample: factor that makes the mean envelope 1, radius of the
                                                     // focused beam in lines, exponent of its Gaussian
layout(binding = 2) uniform samplerBuffer repeats;   // one row per line: V before the window, with REVERBERATION
layout(std430, binding = 0) writeonly buffer Echoes { vec4 echoes[]; };  // one row per line: R, T, S, V

#include "shared/aperture.glsl"

vec4 reflection = vec4(0.0), re = vec4(0.0), im = vec4(0.0), repeated = vec4(0.0), total = vec4(0.0);
int plane_row;             // index of the plane's first sample
vec4 weights = vec4(0.0);  // of the line that is being added, for each of the four lines

// Adds line first + j and returns its intensity. Each call must take the line behind the previous call's line, because
// `weights` moves on by one line per call.
float add(int first, int j, int k) {
  weights = vec4(weight_at(j), weights.xyz);
  int at = first + j, place = plane_row + clamp(at, 0, lines - 1) * samples + k;
  vec4 value = texelFetch(scan, place);
  vec4 weight = at >= 0 && at < lines ? weights : vec4(0.0);
  reflection += weight * value.y;
  re += weight * value.z;
  im += weight * value.w;
#if REVERBERATION == 1
  repeated += weight * texelFetch(repeats, place).x;
#endif
  total += weight;
  return value.x;
}

void main() {
  int k = int(gl_GlobalInvocationID.x), first = 4 * int(gl_GlobalInvocationID.y);
  if (first >= lines || k >= samples) return;
  plane_row = int(gl_GlobalInvocationID.z) * lines * samples;

  vec4 here = texelFetch(at_depth, k);
  place_aperture(here);

  for (int j = -radius; j < 0; ++j) add(first, j, k);
  vec4 intensity;  // one statement each: GLSL leaves open in which order a constructor's arguments are evaluated
  intensity.x = add(first, 0, k);
  intensity.y = add(first, 1, k);
  intensity.z = add(first, 2, k);
  intensity.w = add(first, 3, k);
#if STORED_SPECKLE == 1
  vec4 stored;  // S of the lines themselves
  for (int i = 0; i < 4; ++i)
    stored[i] = texelFetch(scan, plane_row + min(first + i, lines - 1) * samples + k).z;
#endif
  for (int j = 4; j <= radius + 3; ++j) add(first, j, k);

  reflection /= total;
  repeated /= total;
  float least = two_way == 1 ? kMinIntensity : kMinEcho;
  vec4 heard = mix(vec4(0.0), intensity, greaterThan(intensity, vec4(least)));
  vec4 transmission = two_way == 1 ? heard * heard : heard;
#if STORED_SPECKLE == 1
  vec4 envelope = stored;
#else
  vec4 envelope = sqrt(re * re + im * im) / total * here.x;
#endif
  for (int i = 0; i < 4; ++i)
    if (first + i < lines)
      echoes[plane_row + (first + i) * samples + k] = vec4(reflection[i], transmission[i], envelope[i], repeated[i]);
}
