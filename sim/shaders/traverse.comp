// Model S along one scan line: reflection coefficient, transmitted intensity, echo, and the scatterers' echo.
// An invocation a line walks from the face into the depth, because the intensity at a sample depends on all before it.

layout(local_size_x = 8) in;

#include "shared/simulation_parameters.h"
#include "shared/acoustic_volume.glsl"

layout(binding = 1) uniform sampler3D scatterers;  // complex, unit variance at the lattice's points
layout(binding = 0, rgba32f) writeonly uniform image2D scan;  // x line, y sample: I, R, scatterers' echo (re, im)

// A line and the directions beside it, worked out in double precision for each pose: adding up single-precision
// products here instead would move samples by a thousandth of a voxel, which shows at the surface of gas.
struct Line {
  vec4 start, along, lateral, elevation;  // in the volume's texture: a point, and steps of 1 mm
  vec4 lattice_start, lattice_along;      // in the scatterers' lattice
};
layout(std430, binding = 0) readonly buffer ScanLines { Line scan_lines[]; };

const float kScattererScale = 4.0;     // the lattice stores a quarter of its normally distributed numbers
const float kLn10 = 2.302585093;
const float kSpentLogIntensity = -46.0;  // 10^-20: 200 dB down nothing can be heard

vec2 voxel(vec3 at) { return textureLod(acoustic_volume, at, 0.0).rg * 32767.0; }

// Coupling gel fills what air there is between the face and the skin, up to its thickness.
float with_gel(float hu, float r) { return r < gel_mm && hu < kCouplingAirHu ? 0.0 : hu; }

float impedance(vec3 at, float r) { return impedance_and_absorption(with_gel(voxel(at).r, r)).x; }

// ln(1 - alpha) without the cancellation in 1 - alpha: by its series for weak interfaces, as 4 Z1 Z2 / (Z1 + Z2)^2 for
// strong ones.
float log_transmission(float alpha, float z1, float z2) {
  if (alpha < 0.03) return -alpha * (1.0 + alpha * (0.5 + alpha * (1.0 / 3.0 + alpha * 0.25)));
  return log(4.0 * z1 * z2 / ((z1 + z2) * (z1 + z2)));
}

// Trilinear interpolation between independent numbers has less variance between lattice points than at them; dividing
// by what the weights leave keeps the speckle from showing the lattice.
vec2 scatterer(vec3 lattice) {
  vec3 f = fract(lattice * vec3(textureSize(scatterers, 0)) - 0.5);
  vec3 kept = f * f + (1.0 - f) * (1.0 - f);
  return textureLod(scatterers, lattice, 0.0).rg * (kScattererScale * inversesqrt(kept.x * kept.y * kept.z));
}

// |cos| of the angle between the beam and the normal of the interface, from differences over the reflection length.
float incidence(Line line, vec3 at, float r, float along) {
  vec3 lateral = line.lateral.xyz * half_reflection_length_mm;
  vec3 elevation = line.elevation.xyz * half_reflection_length_mm;
  float across = impedance(at + lateral, r) - impedance(at - lateral, r);
  float over = impedance(at + elevation, r) - impedance(at - elevation, r);
  float length_squared = along * along + across * across + over * over;
  return length_squared > 0.0 ? abs(along) * inversesqrt(length_squared) : 0.0;
}

void main() {
  int index = int(gl_GlobalInvocationID.x);
  if (index >= lines) return;
  Line line = scan_lines[index];
  vec3 half_length = line.along.xyz * half_reflection_length_mm;

  float log_intensity = 0.0;
  for (int k = 0; k < samples; ++k) {
    if (log_intensity < kSpentLogIntensity) {
      imageStore(scan, ivec2(index, k), vec4(0.0));
      continue;
    }
    float r = r_min_mm + (float(k) + 0.5) * dr_mm;
    vec3 at = line.start.xyz + r * line.along.xyz;

    vec2 here = voxel(at);
    float absorbed = impedance_and_absorption(with_gel(here.x, r)).y * absorption_per_sample;
    float z_before = impedance(at - half_length, r - half_reflection_length_mm);
    float z_behind = impedance(at + half_length, r + half_reflection_length_mm);
    float rise = z_behind - z_before;
    float alpha = rise / (z_behind + z_before);  // (1)
    alpha *= alpha;

    if (k == 0) log_intensity = -0.5 * absorbed;  // the first sample lies half a step behind the face
    float intensity = exp(log_intensity);
    float reflection = alpha > 0.0 ? alpha * intensity * intensity * incidence(line, at, r, rise) : 0.0;  // (3)
    vec3 lattice = line.lattice_start.xyz + r * line.lattice_along.xyz;
    vec2 echo = exp(here.y * (kLn10 / 1000.0)) * (speckle == 1 ? scatterer(lattice) : vec2(1.0, 0.0));
    imageStore(scan, ivec2(index, k), vec4(intensity, reflection, echo));

    log_intensity += reflection_exponent * log_transmission(alpha, z_before, z_behind) - absorbed;  // (5)
  }
}
