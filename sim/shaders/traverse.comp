// Model S along one scan line: reflection coefficient, transmitted intensity, echo, and the scatterers' echo.
// An invocation a line walks from the face into the depth, because the intensity at a sample depends on all before it.

layout(local_size_x = 8) in;

#include "shared/simulation_parameters.h"
#include "shared/acoustic_volume.glsl"

layout(binding = 1) uniform sampler3D scatterers;  // complex, unit variance at the lattice's points
layout(binding = 0, rgba32f) writeonly uniform image2D scan;  // x line, y sample: I, R, scatterers' echo (re, im)

struct Line {
  vec4 start;      // probe frame, mm; on the face
  vec4 direction;  // probe frame, unit
};
layout(std430, binding = 0) readonly buffer ScanLines { Line scan_lines[]; };

const float kScattererScale = 4.0;     // the lattice stores a quarter of its normally distributed numbers
const float kLn10 = 2.302585093;
const float kSpentLogIntensity = -46.0;  // 10^-20: 200 dB down nothing can be heard

vec2 voxel(vec3 probe_mm) {
  return textureLod(acoustic_volume, (texture_from_probe * vec4(probe_mm, 1.0)).xyz, 0.0).rg * 32767.0;
}

// Coupling gel fills what air there is between the face and the skin, up to its thickness.
float with_gel(float hu, float r) { return r < gel_mm && hu < kCouplingAirHu ? 0.0 : hu; }

float impedance(vec3 probe_mm, float r) { return impedance_and_absorption(with_gel(voxel(probe_mm).r, r)).x; }

// ln(1 - a), by its series where 1 - a would round a's digits away.
float log_transmission(float a) {
  return a < 0.03 ? -a * (1.0 + a * (0.5 + a * (1.0 / 3.0 + a * 0.25))) : log(1.0 - a);
}

// Trilinear interpolation between independent numbers has less variance between lattice points than at them; dividing
// by what the weights leave keeps the speckle from showing the lattice.
vec2 scatterer(vec3 probe_mm) {
  vec3 lattice = (lattice_from_probe * vec4(probe_mm, 1.0)).xyz;
  vec3 f = fract(lattice * vec3(textureSize(scatterers, 0)) - 0.5);
  vec3 kept = f * f + (1.0 - f) * (1.0 - f);
  return textureLod(scatterers, lattice, 0.0).rg * (kScattererScale * inversesqrt(kept.x * kept.y * kept.z));
}

// |cos| of the angle between the beam and the normal of the interface, from differences over the reflection length.
float incidence(vec3 p, vec3 direction, float r, float along) {
  vec3 lateral = vec3(direction.y, -direction.x, 0.0) * half_reflection_length_mm;
  vec3 elevation = cross(direction, normalize(lateral)) * half_reflection_length_mm;
  float across = impedance(p + lateral, r) - impedance(p - lateral, r);
  float over = impedance(p + elevation, r) - impedance(p - elevation, r);
  float length_squared = along * along + across * across + over * over;
  return length_squared > 0.0 ? abs(along) * inversesqrt(length_squared) : 0.0;
}

void main() {
  int line = int(gl_GlobalInvocationID.x);
  if (line >= lines) return;
  vec3 start = scan_lines[line].start.xyz;
  vec3 direction = scan_lines[line].direction.xyz;

  float log_intensity = 0.0;
  for (int k = 0; k < samples; ++k) {
    if (log_intensity < kSpentLogIntensity) {
      imageStore(scan, ivec2(line, k), vec4(0.0));
      continue;
    }
    float r = r_min_mm + (float(k) + 0.5) * dr_mm;
    vec3 p = start + direction * r;
    vec3 half_length = direction * half_reflection_length_mm;

    vec2 here = voxel(p);
    float absorbed = impedance_and_absorption(with_gel(here.x, r)).y * absorption_per_sample;
    float z_before = impedance(p - half_length, r - half_reflection_length_mm);
    float z_behind = impedance(p + half_length, r + half_reflection_length_mm);
    float along = z_behind - z_before;
    float alpha = along / (z_behind + z_before);  // (1)
    alpha *= alpha;

    if (k == 0) log_intensity = -0.5 * absorbed;  // the first sample lies half a step behind the face
    float intensity = exp(log_intensity);
    float reflection = alpha > 0.0 ? alpha * intensity * intensity * incidence(p, direction, r, along) : 0.0;  // (3)
    vec2 echo = exp(here.y * (kLn10 / 1000.0)) * (speckle == 1 ? scatterer(p) : vec2(1.0, 0.0));
    imageStore(scan, ivec2(line, k), vec4(intensity, reflection, echo));

    log_intensity += reflection_exponent * log_transmission(alpha) - absorbed;  // (5)
  }
}
