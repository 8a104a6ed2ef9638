// Mirror images: echoes of what lies before gas, which sound meets on its way back from the gas.
// sim/model/mirror_image.h gives the formula.
//
// Reads I and R of the slice's middle plane. Adds to e of the samples behind gas, from samples before it.
// Dispatch: one invocation per line of all planes, in rows of work groups of GROUP (shared/rows.glsl).

layout(local_size_x = GROUP) in;

#include "shared/simulation_parameters.h"
#include "shared/reflectors.glsl"
#include "shared/rows.glsl"

layout(std430, binding = 1) buffer Scan { vec4 echoes[]; };  // one row per line: I, scattered power, e (re, im)

// Returns the share of sound that is lost at a sample.
float loss(int k) {
  float arriving = intensity(k);
  return arriving > kLeastReverberant ? 1.0 - pow(min(intensity(k + 1) / arriving, 1.0), 1.0 / reflection_exponent) : 0.0;
}

float before(int k) { return intensity(k - reach() + 1); }

vec2 echo(int k) { return k < 0 ? vec2(0.0) : echoes[row + k].zw; }

// Adds the image of what lies before the interface that sample j shows.
void add_image(int j, float amplitude) {
  float c = place_of_interface(j), arriving = before(j);
  // All samples behind take theirs from equally far between two samples before.
  float low_of_first = floor(2.0 * c - float(j + 1)), f = 2.0 * c - float(j + 1) - low_of_first;
  float even = inversesqrt(f * f + (1.0 - f) * (1.0 - f));
  int low = int(low_of_first);
  for (int k = j + 1; k < samples && low >= -1; ++k, --low) {
    float apart = c - (float(low) + f);
    float separate = clamp(apart * reflection_exponent - 1.0, 0.0, 1.0);
    if (separate == 0.0) continue;
    float way = min(arriving / mix(intensity(low), intensity(low + 1), f), 1.0);
    echoes[row + k].zw += amplitude * separate * even * way * way * mix(echo(low), echo(low + 1), f);
  }
}

void main() {
  int line = invocation_in_rows();
  if (line >= planes * lines) return;
  row = line * samples;

  // The list comes first, as for reverberation.
  int at[kMostMirrors];
  int count = 0;
  for (int k = 0; k < samples && count < kMostMirrors; ++k) {
    if (loss(k) <= kLeastMirror) continue;
    if (count > 0 && before(k) < kLeastBehindFirst * before(at[0])) break;
    at[count++] = k;
  }
  float share = mirror_amplitude * min(reflection_exponent, 1.0);
  for (int n = 0; n < count; ++n) add_image(at[n], share * smoothstep(kLeastMirror, kFullMirror, loss(at[n])));
}
