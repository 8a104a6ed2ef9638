// Beam width (4): reflections and scatterers' echoes across the lines of the active aperture. Scatterers add up as
// complex amplitudes before their envelope is taken, which is what makes speckle.
//
// An invocation serves four neighbouring lines, whose apertures overlap: a value is read once for all four. It is
// compiled for the beam's half width BEAM_HALF, so that a narrow aperture needs no loop. A plane's window ends at its own
// outer lines: the first line of the next plane lies at the array's other end.

layout(local_size_x = 64) in;

#include "shared/simulation_parameters.h"
#include "shared/least_echo.glsl"

layout(binding = 0) uniform samplerBuffer scan;      // a row a line: I, R, scatterers' echo (re, im)
layout(binding = 1) uniform samplerBuffer at_depth;  // a sample: mean envelope -> 1, focused beam's reach in lines,
                                                     // exponent
layout(binding = 2) uniform samplerBuffer repeats;   // a row a line: V before the window, with REVERBERATION
layout(std140, binding = 1) uniform Window { vec4 window[32]; };         // weights from the middle line outwards
layout(std430, binding = 0) writeonly buffer Echoes { vec4 echoes[]; };  // a row a line: R, T, S, V

#if FOCUSED_BEAM == 1
int reach;       // of the aperture at this sample, in lines to either side
float exponent;  // of its Gaussian
#else
const int reach = BEAM_HALF;
#endif
vec4 reflection = vec4(0.0), re = vec4(0.0), im = vec4(0.0), repeated = vec4(0.0), total = vec4(0.0);
int plane_row;             // where the plane's lines begin
vec4 weights = vec4(0.0);  // each of the four lines' for the line that is being added

// Of a line so many lines away from the aperture's middle.
float weight_at(int away) {
#if FOCUSED_BEAM == 1
  return abs(away) <= reach ? exp(exponent * float(away * away)) : 0.0;
#else
  int place = abs(away);
  return place <= reach ? window[place >> 2][place & 3] : 0.0;
#endif
}

// Adds line first + j, one behind the line added before, and gives its intensity.
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
#if FOCUSED_BEAM == 1
  reach = int(here.y);
  exponent = here.z;
#endif

  for (int j = -reach; j < 0; ++j) add(first, j, k);
  vec4 intensity;  // a statement each: in what order a constructor's arguments are worked out is left open
  intensity.x = add(first, 0, k);
  intensity.y = add(first, 1, k);
  intensity.z = add(first, 2, k);
  intensity.w = add(first, 3, k);
  for (int j = 4; j <= reach + 3; ++j) add(first, j, k);

  reflection /= total;
  repeated /= total;
  float least = two_way == 1 ? kLeastIntensity : kLeastEcho;
  vec4 heard = mix(vec4(0.0), intensity, greaterThan(intensity, vec4(least)));
  vec4 transmission = two_way == 1 ? heard * heard : heard;
  vec4 envelope = sqrt(re * re + im * im) / total * here.x;
  for (int i = 0; i < 4; ++i)
    if (first + i < lines)
      echoes[plane_row + (first + i) * samples + k] = vec4(reflection[i], transmission[i], envelope[i], repeated[i]);
}
