// Mirror images: echoes of what lies before gas, which sound meets on its way back from the gas.
// sim/model/mirror_image.h gives the formula.
//
// Reads I and R of the slice's middle plane. Adds to e of the samples behind gas, from samples before all gas.
// Dispatch: one invocation per PART samples of a line of all planes, in rows of work groups of GROUP (shared/rows.glsl).
// Each finds the gas of its line itself: few lines have any.

layout(local_size_x = GROUP) in;

#include "shared/simulation_parameters.h"
#include "shared/reflectors.glsl"
#include "shared/rows.glsl"

layout(std430, binding = 1) buffer Scan { vec4 echoes[]; };  // one row per line: I, scattered power, e (re, im)

// Returns the share of sound that is lost at a sample.
float loss(int k) {
  float arriving = intensity(k);
  return arriving > kMinReverberant ? 1.0 - pow(min(intensity(k + 1) / arriving, 1.0), 1.0 / reflection_exponent) : 0.0;
}

// Returns the first sample at or behind j, in steps of `counting`, that may lose enough to mirror; `end` or more if none
// does. A loop of its own: a software renderer executes what follows for every sample that this does not pass over.
int next_loss(int j, int counting, int end) {
  float kept = pow(1.0 - kMinMirror, reflection_exponent) * 1.00001;  // with room for the rounding in loss()
  while (j < end && intensity(j + 1) >= kept * intensity(j)) j += counting;
  return j;
}

int gas;  // the line's first sample in gas

// Returns e of a sample before it.
vec2 echo(int k) { return k < 0 || k >= gas ? vec2(0.0) : echoes[row + k].zw; }

// Adds an image of what lies before an interface at c, which sound reaches with the intensity `arriving`, to the samples
// from `first` to before `end`. Sample k shows what lies at `mirrored` - k.
void add_image(float c, float arriving, float mirrored, float amplitude, int first, int end) {
  // All samples take theirs from equally far between two samples before.
  float low_of_first = floor(mirrored - float(first)), f = mirrored - float(first) - low_of_first;
  float even = inversesqrt(f * f + (1.0 - f) * (1.0 - f));
  int low = int(low_of_first);
  for (int k = first; k < end && low >= -1; ++k, --low) {
    float apart = c - (float(low) + f);
    float separate = clamp(apart * reflection_exponent - 1.0, 0.0, 1.0);
    if (separate == 0.0 || low >= gas) continue;
    float way = min(arriving / mix(intensity(low), intensity(low + 1), f), 1.0);
    echoes[row + k].zw += amplitude * separate * even * way * way * mix(echo(low), echo(low + 1), f);
  }
}

// Adds the images that the interface makes which sample j shows, one per round trip to the face.
void add_images(int j, float amplitude, int first, int end) {
  float c = place_of_interface(j, kOwnPlace), arriving = intensity(j - reach() + 1);
  float from_face = c + 0.5 + r_min_mm / dr_mm, kept = 1.0;
  for (float trips = 1.0; kept >= kMinOfFace && trips * from_face < float(samples) + from_face - c; ++trips) {
    float before = (trips - 1.0) * from_face;
    add_image(c, arriving, 2.0 * c + before, amplitude * kept, max(first, int(before)), end);
    kept *= face_amplitude * arriving;
  }
}

void main() {
  int part = invocation_in_rows(), all_lines = planes * lines;
  int first = part / all_lines * PART, end = min(first + PART, samples);
  row = part % all_lines * samples;
  gas = samples;
  int counting = max(int(0.25 / reflection_exponent + 1e-3), 1);
  float of_sample = min(float(counting) * reflection_exponent, 1.0), left = kMaxMirrored;
  for (int j = next_loss(0, counting, end - 1); j < end - 1 && left > 0.0;
       j = next_loss(j + counting, counting, end - 1)) {
    float share = min(of_sample * smoothstep(kMinMirror, kFullMirror, loss(j)), left);
    if (share <= 0.0) continue;
    gas = min(gas, j);
    left -= share;
    add_images(j, mirror_amplitude * share, max(first, j + 1), end);
  }
}
