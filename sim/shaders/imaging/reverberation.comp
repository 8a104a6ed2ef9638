// Reverberation: V, the echoes of sound that goes to and fro between strong interfaces, and between them and the
// probe's face. sim/model/reverberation.h gives the formula.
//
// Reads I and R of the slice's middle plane. Adds to V, which is 0 before.
// Dispatch: one invocation per line of all planes, in rows of work groups of GROUP (shared/rows.glsl). An invocation
// lists the samples that reflect strongly, which are few as a rule. It adds the echoes that each makes with those
// before.

layout(local_size_x = GROUP) in;

#include "shared/simulation_parameters.h"
#include "shared/least_echo.glsl"
#include "shared/reflectors.glsl"
#include "shared/rows.glsl"

layout(std430, binding = 0) buffer Repeats { float repeats[]; };  // one row per line: V, 0 before

// Adds `echo` at a position between two samples: the cubic B-spline shares it among the nearest four.
void add(float position, float echo) {
  int low = int(floor(position));
  float f = position - float(low), g = 1.0 - f;
  vec4 share = vec4(g * g * g, 4.0 - f * f * (6.0 - 3.0 * f), 4.0 - g * g * (6.0 - 3.0 * g), f * f * f) * (echo / 6.0);
  for (int i = 0; i < 4; ++i)
    if (low - 1 + i >= 0 && low - 1 + i < samples && share[i] > kMinEcho) repeats[row + low - 1 + i] += share[i];
}

// Returns what a round trip that leaves the share `round_trip` counts as: 0 for `least` and below.
float counted(float round_trip, float least) {
  float share = least / max(round_trip, least);
  float above = 1.0 - share * share, squared = above * above, to_the_fourth = squared * squared;
  return round_trip * to_the_fourth * to_the_fourth;
}

// Adds the repeats of sample k, which lies `apart` samples behind another reflector. A round trip between the two
// leaves the share `gain`.
void repeat(int k, float echo, float apart, float gain) {
  float position = float(k) + apart;
  // The spline of a position less than two samples behind the last sample still covers that sample.
  for (int n = 0; n < kMaxRepeats && position < float(samples + 1); ++n, position += apart) {
    echo *= gain;
    if (echo < kMinEcho) return;
    add(position, echo);
  }
}

void main() {
  int line = invocation_in_rows();
  if (line >= planes * lines) return;
  row = line * samples;

  // The list comes first: renderers that run lanes in lockstep would spend on every sample what only these need.
  int at[kMaxReflectors];
  int count = 0;
  for (int k = 0; k < samples && count < kMaxReflectors; ++k)
    if (reflected(k).x > kMinRound) at[count++] = k;

  float length_in_samples = 2.0 * half_reflection_length;
  float share = min(reflection_exponent, 1.0);
  float strength[kMaxReflectors], place[kMaxReflectors], behind[kMaxReflectors];
  for (int j = 0; j < count; ++j) {
    int k = at[j];
    vec2 here = reflected(k);
    float c = place_of_interface(k, 0.0), before = intensity(k - reach() + 1);
#if AT_FACE == 1
    float of_face = face_reflection * counted(here.x * before * before, kMinFromFace);
    if (of_face > 0.0) repeat(k, here.y, c + 0.5 + r_min_mm / dr_mm, of_face);
#endif
#if IN_TISSUE == 1
    for (int i = 0;;) {
      float apart = 0.0, gain = 0.0;
      for (; i < j && gain == 0.0; ++i) {  // finds the next pair that leaves something
        apart = c - place[i];
        float between = min(before / behind[i], 1.0);
        float separate = clamp(2.0 * apart / length_in_samples - 1.0, 0.0, 1.0);
        gain = counted(separate * strength[i] * here.x * between * between, kMinRound);
      }
      if (gain == 0.0) break;
      repeat(k, here.y * share, apart, gain);
    }
    strength[j] = here.x;
    place[j] = c;
    behind[j] = max(intensity(k + reach()), 1e-30);
#endif
  }
}
