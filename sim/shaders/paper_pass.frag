// Pass k of the traversal as Kutter, Shams and Navab 2009 run it: sample k of every scan line, a fragment a line. What
// a sample needs of the one before it comes from the target of pass k - 1.

#include "shared/acoustic_volume.glsl"

layout(location = 0) uniform float r_min_mm;
layout(location = 1) uniform float dr_mm;
layout(location = 2) uniform float half_length_mm;  // l/2
layout(location = 3) uniform float exponent;        // dr/l
layout(location = 4) uniform float absorption;      // times dB/(cm MHz), the natural logarithm that a sample takes
layout(location = 5) uniform float gel_mm;

struct Line {
  vec4 start, along, lateral, elevation;  // in the volume's texture: a point, and steps of 1 mm
};
layout(std430, binding = 0) readonly buffer ScanLines { Line scan_lines[]; };
layout(binding = 1) uniform sampler2D previous;  // as `carried`, of pass k - 1

layout(location = 0) flat in int k;
layout(location = 0) out vec2 scan;     // I, R
layout(location = 1) out vec2 carried;  // I behind this sample, HU half a reflection length behind it

float density(vec3 at, float r) {
  float hu = textureLod(acoustic_volume, at, 0.0).r * 32767.0;
  return r < gel_mm && hu < kCouplingAirHu ? 0.0 : hu;
}

// ln(1 - alpha), by its series where 1 - alpha would lose the digits of a weak interface.
float log_transmission(float alpha, float z1, float z2) {
  if (alpha < 0.03) return -alpha * (1.0 + alpha * (0.5 + alpha * (1.0 / 3.0 + alpha * 0.25)));
  return log(4.0 * z1 * z2 / ((z1 + z2) * (z1 + z2)));
}

void main() {
  int index = int(gl_FragCoord.x);
  Line line = scan_lines[index];
  float r = r_min_mm + (float(k) + 0.5) * dr_mm;
  vec3 at = line.start.xyz + r * line.along.xyz;
  vec2 before = k > 0 ? texelFetch(previous, ivec2(index, k - 1), 0).xy : vec2(1.0, 0.0);

  float absorbed = 0.0;
  if (absorption > 0.0) absorbed = absorption * impedance_and_absorption(density(at, r)).y;
  float intensity = k > 0 ? before.x : exp(-0.5 * absorbed);  // the first sample lies half a step behind the face

  vec3 half_length = line.along.xyz * half_length_mm;
  float hu_before = before.y;
#ifdef CARRIES_DENSITY
  if (k == 0)
#endif
    hu_before = density(at - half_length, r - half_length_mm);
  float hu_behind = density(at + half_length, r + half_length_mm);
  float z_before = impedance_and_absorption(hu_before).x, z_behind = impedance_and_absorption(hu_behind).x;
  float alpha = (z_behind - z_before) / (z_behind + z_before);  // (1)
  alpha *= alpha;

  float reflection = 0.0;
  if (alpha > 0.0) {
    vec3 lateral = line.lateral.xyz * half_length_mm;
    vec3 elevation = line.elevation.xyz * half_length_mm;
    float rise = hu_behind - hu_before;
    float across = density(at + lateral, r) - density(at - lateral, r);
    float over = density(at + elevation, r) - density(at - elevation, r);
    float cosine = abs(rise) * inversesqrt(rise * rise + across * across + over * over);
    reflection = alpha * intensity * intensity * cosine;  // (3)
  }
  scan = vec2(intensity, reflection);
  carried = vec2(intensity * exp(exponent * log_transmission(alpha, z_before, z_behind) - absorbed), hu_behind);  // (5)
}
