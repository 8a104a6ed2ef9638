// Interfaces of a scan line that reflect so strongly that sound meets them more than once: sim/model/reverberation.h and
// sim/model/mirror_image.h. The file that includes this one sets `row` first.

#include "shared/model_constants.h"

layout(binding = 0) uniform samplerBuffer scan;  // one row per line: I, R of the slice's middle plane

int row;  // index of the line's first sample
float intensity(int k) { return texelFetch(scan, row + clamp(k, 0, samples - 1)).x; }

// Returns the reflection length in whole samples, rounded up.
int reach() { return max(int(ceil(2.0 * half_reflection_length - 1e-3)), 1); }

// A compensated (Kahan) sum. An echo's distance from its interface grows with an error of the interface's place.
struct Sum { float value, excess; };
Sum added(Sum sum, float term) {
  precise float less = term - sum.excess;
  precise float value = sum.value + less;
  precise float excess = (value - sum.value) - less;
  return Sum(value, excess);
}

// Returns A and R of a sample.
vec2 reflected(int k) {
  vec2 value = texelFetch(scan, row + k).xy;
  return value.x > kMinReverberant ? vec2(min(value.y / (value.x * value.x), 1.0), value.y) : vec2(0.0);
}

// Returns c of the interface that sample k shows, in samples; its own place counts `own` besides.
float place_of_interface(int k, float own) {
  Sum sum = Sum(own, 0.0), moment = Sum(0.0, 0.0);
  for (int other = max(k - reach() + 1, 0); other <= min(k + reach() - 1, samples - 1); ++other) {
    float weight = reflected(other).x;
    sum = added(sum, weight);
    moment = added(moment, weight * float(other - k));
  }
  return float(k) + (sum.value > 0.0 ? moment.value / sum.value : 0.0);
}
