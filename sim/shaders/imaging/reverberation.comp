// Echoes of sound that goes to and fro between strong interfaces, and between them and the probe's face: the formula is
// in sim/model/reverberation.h. An invocation takes a line: it lists the samples that reflect much, few as a rule, and
// adds what each makes with those before it.

layout(local_size_x = GROUP) in;

#include "shared/simulation_parameters.h"
#include "shared/least_echo.glsl"
#include "shared/rows.glsl"

layout(binding = 0) uniform samplerBuffer scan;                   // a row a line: I, R of the slice's middle plane
layout(std430, binding = 0) buffer Repeats { float repeats[]; };  // a row a line: V, 0 before

const int kMostReflectors = 64, kMostRepeats = 16;  // as in sim/model/reverberation.h, with the next
const float kLeastRound = 1e-3, kLeastFromFace = 1e-2, kLeastReverberant = 1e-12;

int row;  // where the line begins
float intensity(int k) { return texelFetch(scan, row + clamp(k, 0, samples - 1)).x; }

// A of a sample, and its R.
vec2 reflected(int k) {
  vec2 value = texelFetch(scan, row + k).xy;
  return value.x > kLeastReverberant ? vec2(min(value.y / (value.x * value.x), 1.0), value.y) : vec2(0.0);
}

// What rounding added is carried along: a repeat lies as far away as c does, and is as steep as its spline.
struct Sum { float value, excess; };
Sum added(Sum sum, float term) {
  precise float less = term - sum.excess;
  precise float value = sum.value + less;
  precise float excess = (value - sum.value) - less;
  return Sum(value, excess);
}

// Adds `echo` around a place between two samples, by the cubic B-spline.
void add(float position, float echo) {
  int low = int(floor(position));
  float f = position - float(low), g = 1.0 - f;
  vec4 share = vec4(g * g * g, 4.0 - f * f * (6.0 - 3.0 * f), 4.0 - g * g * (6.0 - 3.0 * g), f * f * f) * (echo / 6.0);
  for (int i = 0; i < 4; ++i)
    if (low - 1 + i >= 0 && low - 1 + i < samples && share[i] > kLeastEcho) repeats[row + low - 1 + i] += share[i];
}

// What counts of a round that leaves so much.
float counted(float round_trip, float least) {
  float share = least / max(round_trip, least);
  float above = 1.0 - share * share, squared = above * above, to_the_fourth = squared * squared;
  return round_trip * to_the_fourth * to_the_fourth;
}

// Sample k, which lies `apart` behind another reflector, with what a round between them leaves.
void repeat(int k, float echo, float apart, float gain) {
  float position = float(k) + apart;
  // The spline reaches before the line's end from a sample behind it.
  for (int n = 0; n < kMostRepeats && position < float(samples + 1); ++n, position += apart) {
    echo *= gain;
    if (echo < kLeastEcho) return;
    add(position, echo);
  }
}

void main() {
  int line = invocation_in_rows();
  if (line >= planes * lines) return;
  row = line * samples;

  // Listed first: renderers that run lanes in step would spend on every sample what only these need.
  int at[kMostReflectors];
  int count = 0;
  for (int k = 0; k < samples && count < kMostReflectors; ++k)
    if (reflected(k).x > kLeastRound) at[count++] = k;

  float length_in_samples = 2.0 * half_reflection_length;
  int near = max(int(ceil(length_in_samples - 1e-3)), 1);  // l in whole samples
  float share = min(reflection_exponent, 1.0);
  float strength[kMostReflectors], place[kMostReflectors], behind[kMostReflectors];
  for (int j = 0; j < count; ++j) {
    int k = at[j];
    vec2 here = reflected(k);
    Sum sum = Sum(0.0, 0.0), moment = sum;
    for (int other = max(k - near + 1, 0); other <= min(k + near - 1, samples - 1); ++other) {
      float weight = reflected(other).x;
      sum = added(sum, weight);
      moment = added(moment, weight * float(other - k));
    }
    float c = float(k) + moment.value / sum.value, before = intensity(k - near + 1);
#if AT_FACE == 1
    float of_face = face_reflection * counted(here.x * before * before, kLeastFromFace);
    if (of_face > 0.0) repeat(k, here.y, c + 0.5 + r_min_mm / dr_mm, of_face);
#endif
#if IN_TISSUE == 1
    for (int i = 0;;) {
      float apart = 0.0, gain = 0.0;
      for (; i < j && gain == 0.0; ++i) {  // most pairs leave nothing, and only what is found is worth a repeat
        apart = c - place[i];
        float between = min(before / behind[i], 1.0);
        float separate = clamp(2.0 * apart / length_in_samples - 1.0, 0.0, 1.0);
        gain = counted(separate * strength[i] * here.x * between * between, kLeastRound);
      }
      if (gain == 0.0) break;
      repeat(k, here.y * share, apart, gain);
    }
    strength[j] = here.x;
    place[j] = c;
    behind[j] = max(intensity(k + near), 1e-30);
#endif
  }
}
