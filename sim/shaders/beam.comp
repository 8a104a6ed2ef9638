// Beam width (4): reflections and scatterers' echoes across the lines of the active aperture. Scatterers add up as
// complex amplitudes before their envelope is taken, which is what makes speckle.
//
// An invocation serves four neighbouring lines, whose apertures overlap: a value is read once for all four.

layout(local_size_x = 64) in;

#include "shared/simulation_parameters.h"

layout(binding = 0) uniform sampler2D scan;     // a row a line: I, R, scatterers' echo (re, im)
layout(binding = 1) uniform sampler2D repeats;  // a row a line: V before the window, with REVERBERATION
layout(std430, binding = 0) readonly buffer Window { vec4 window[]; };  // of four lines, by place from the first's edge
layout(std430, binding = 1) readonly buffer SpeckleScale { float envelope_scale[]; };  // a sample: mean envelope -> 1
layout(std430, binding = 2) readonly buffer Focused { vec2 focused[]; };  // a sample: reach in lines, exponent
layout(binding = 0, rgba32f) writeonly uniform image2D echoes;                         // a row a line: R, T, S, V

vec4 reflection = vec4(0.0), re = vec4(0.0), im = vec4(0.0), repeated = vec4(0.0), total = vec4(0.0);

// How much each of the four lines takes of line first + j. FOCUSED_BEAM: by a Gaussian instead of the window.
int reach;
float exponent;
vec4 weight_of(int j) {
#if FOCUSED_BEAM == 1
  vec4 away = float(j) - vec4(0.0, 1.0, 2.0, 3.0);
  return vec4(lessThanEqual(abs(away), vec4(reach))) * exp(exponent * away * away);
#else
  return window[j + beam_half];
#endif
}

// Adds line first + j, and gives its intensity.
float add(int first, int j, int k) {
  int at = first + j;
  bool exists = at >= 0 && at < lines;
  vec4 value = texelFetch(scan, ivec2(k, clamp(at, 0, lines - 1)), 0);
  vec4 weight = exists ? weight_of(j) : vec4(0.0);
  reflection += weight * value.y;
  re += weight * value.z;
  im += weight * value.w;
#if REVERBERATION == 1
  repeated += weight * texelFetch(repeats, ivec2(k, clamp(at, 0, lines - 1)), 0).x;
#endif
  total += weight;
  return value.x;
}

void main() {
  int k = int(gl_GlobalInvocationID.x), first = 4 * int(gl_GlobalInvocationID.y);
  if (first >= lines || k >= samples) return;

#if FOCUSED_BEAM == 1
  reach = int(focused[k].x);
  exponent = focused[k].y;
#else
  reach = beam_half;
#endif

  for (int j = -reach; j < 0; ++j) add(first, j, k);
  vec4 intensity = vec4(add(first, 0, k), add(first, 1, k), add(first, 2, k), add(first, 3, k));
  for (int j = 4; j <= reach + 3; ++j) add(first, j, k);

  reflection /= total;
  repeated /= total;
  vec4 transmission = two_way == 1 ? intensity * intensity : intensity;
  vec4 envelope = sqrt(re * re + im * im) / total * (speckle == 1 ? envelope_scale[k] : 1.0);
  for (int i = 0; i < 4; ++i)
    if (first + i < lines)
      imageStore(echoes, ivec2(k, first + i), vec4(reflection[i], transmission[i], envelope[i], repeated[i]));
}
