// Pass k of the traversal as Kutter, Shams and Navab 2009 run it: sample k of every scan line, one fragment per line.
// Values from earlier samples come from the target of pass k - 1.

#include "shared/acoustic_volume.glsl"

layout(location = 0) uniform float r_min_mm;
layout(location = 1) uniform float dr_mm;
layout(location = 2) uniform float half_length_mm;  // l/2
layout(location = 3) uniform float exponent;        // dr/l
layout(location = 4) uniform float absorption;      // factor from dB/(cm MHz) to the natural logarithm of one sample
layout(location = 5) uniform float coupling_depth_mm;

struct Line {
  vec4 start, along, lateral, elevation;  // in texture coordinates of the volume: a point, and steps of 1 mm
};
layout(std430, binding = 0) readonly buffer ScanLines { Line scan_lines[]; };
layout(binding = 1) uniform sampler2D previous;  // `carried` of pass k - 1

layout(location = 0) flat in int k;
layout(location = 0) out vec2 scan;     // I, R
layout(location = 1) out vec4 carried;  // I behind this sample, and values that the next pass reuses

float density(vec3 at, float r) {
  float hu = textureLod(acoustic_volume, at, 0.0).r * 32767.0;
  return r < coupling_depth_mm ? (1.0 - gel_share(hu)) * hu : hu;
}

// ln(1 - alpha), as a series where 1 - alpha would lose the digits of a weak interface.
float log_transmission(float alpha, float z1, float z2) {
  if (alpha < 0.03) return -alpha * (1.0 + alpha * (0.5 + alpha * (1.0 / 3.0 + alpha * 0.25)));
  return log(4.0 * z1 * z2 / ((z1 + z2) * (z1 + z2)));
}

void main() {
  int index = int(gl_FragCoord.x);
  Line line = scan_lines[index];
  float r = r_min_mm + (float(k) + 0.5) * dr_mm;
  vec3 at = line.start.xyz + r * line.along.xyz, half_length = line.along.xyz * half_length_mm;
  vec4 known = texelFetch(previous, ivec2(index, max(k - 1, 0)), 0);
  bool first = k == 0;

  // Density and impedance half a reflection length in front of the sample.
  vec2 before = known.yz;
  if (first || SAMPLES_A_LENGTH == 0) {
    before.x = density(at - half_length, r - half_length_mm);
    before.y = impedance_and_absorption(before.x).x;
  }
  float hu_here = known.w;
  vec2 here = vec2(0.0);  // impedance and absorption
  if (absorption > 0.0 || SAMPLES_A_LENGTH == 2) {
    if (first || SAMPLES_A_LENGTH != 2) hu_here = density(at, r);
    here = impedance_and_absorption(hu_here);
  }
  vec2 behind;
  behind.x = density(at + half_length, r + half_length_mm);
  behind.y = impedance_and_absorption(behind.x).x;

  float alpha = (behind.y - before.y) / (behind.y + before.y);  // (1)
  alpha *= alpha;
  float absorbed = absorption * here.y;
  float intensity = first ? exp(-0.5 * absorbed) : known.x;  // the first sample lies half a step behind the face

  float reflection = 0.0;
  if (alpha > 0.0) {
    vec3 lateral = line.lateral.xyz * half_length_mm;
    vec3 elevation = line.elevation.xyz * half_length_mm;
    float rise = behind.x - before.x;
    float across = density(at + lateral, r) - density(at - lateral, r);
    float over = density(at + elevation, r) - density(at - elevation, r);
    float cosine = abs(rise) * inversesqrt(rise * rise + across * across + over * over);
    reflection = alpha * intensity * intensity * cosine;  // (3)
  }
  scan = vec2(intensity, reflection);
  intensity *= exp(exponent * log_transmission(alpha, before.y, behind.y) - absorbed);  // (5)
  carried = SAMPLES_A_LENGTH == 2 ? vec4(intensity, hu_here, here.x, behind.x) : vec4(intensity, behind, 0.0);
}
