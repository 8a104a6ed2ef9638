// Model W along one scan line, an invocation a line, for all the images of a chunk at once: echogenicity, reflection,
// transmitted intensity. The gradient is stored with the density, so a sample costs one fetch.

layout(local_size_x = 8) in;

#include "shared/wein_parameters.h"

layout(binding = 0) uniform sampler3D density;  // (HU, gradient along the CT's axes in eighths of HU) / 32767
layout(binding = 0, rgba32f) writeonly uniform image2D scan;  // a row a line, image after image: E, R, I, 0

// Worked out in double precision for each pose.
struct Line {
  vec4 start, along;  // in the texture: of sample 0, and to the next
  vec4 direction;     // unit, along the CT's axes
};
layout(std430, binding = 0) readonly buffer ScanLines { Line scan_lines[]; };

const float kAirMu = 1.2;
const float kContactAirHu = -300.0;
const float kNothing = -1e6;  // the logarithm of what total reflection lets pass, in effect

void main() {
  int index = int(gl_GlobalInvocationID.x);
  if (index >= lines * images) return;
  Line line = scan_lines[index];
  float log_intensity = 0.0;
  for (int k = 0; k < samples; ++k) {
    vec4 here = textureLod(density, line.start.xyz + float(k) * line.along.xyz, 0.0) * 32767.0;
    bool contact = float(k) < first_free_sample;
    float hu = contact && here.x < kContactAirHu ? 0.0 : here.x;
    vec3 gradient = contact ? vec3(0.0) : here.yzw * 0.125;
    float squared = dot(gradient, gradient), steepness = sqrt(squared);
    float change = min(steepness / (2.0 * max(hu + 1000.0, kAirMu)), 1.0);
    float cosine = abs(dot(line.direction.xyz, gradient)) / max(steepness, 1e-20);

    float intensity = exp(log_intensity);
    float reflection = log(1.0 + compression * intensity * change * change * cosine) * one_over_compressed_one;
    float echogenicity = clamp((hu - dark_hu) * one_over_hu_range, 0.0, 1.0);
    if (shadows == 1) echogenicity *= intensity;
    imageStore(scan, ivec2(k, index), vec4(echogenicity, reflection, intensity, 0.0));

    log_intensity += dr_by_length * (change < 1.0 ? log(1.0 - change * change) : kNothing / dr_by_length);
  }
}
