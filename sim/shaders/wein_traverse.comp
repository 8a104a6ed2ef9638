// Model W along one scan line, an invocation a line, for all the images of a chunk at once: echogenicity, reflection,
// transmitted intensity. The gradient is stored with the density, so a sample costs one fetch. Groups follow each other
// image by image along the same few lines: poses of a search lie close together, so the voxels are still in the cache.

layout(local_size_x = GROUP) in;

#include "shared/wein_parameters.h"
#include "shared/exact_filter.glsl"

layout(binding = 0) uniform sampler3D density;  // (HU, gradient along the CT's axes in eighths of HU) / 32767
layout(binding = 1) uniform sampler2D probe_lines;  // a row a line, probe's frame, mm: sample 0, the way to the next
layout(binding = 2) uniform sampler2D places;       // a row an image: the rows of texture_from_probe
layout(std430, binding = 0) writeonly buffer Scan { uint scan[]; };  // image by image, a row a line: E, R, 16 bits each
layout(std430, binding = 1) buffer Counter { uint samples_walked; };  // of a call
#ifdef INTENSITY
layout(binding = 1, r32f) writeonly uniform image2D intensities;  // of the first image
#endif

const float kAirMu = 1.2;
const float kContactAirHu = -300.5;
const float kNothing = -1e6;  // the logarithm of what total reflection lets pass, in effect

void tell(int k, int line, int image, float echogenicity, float reflection, float intensity) {
  scan[(image * lines + line) * samples + k] = packUnorm2x16(vec2(echogenicity, reflection));
#ifdef INTENSITY
  imageStore(intensities, ivec2(k, line), vec4(intensity));
#endif
}

void main() {
  int image = int(gl_WorkGroupID.x), line = int(gl_WorkGroupID.y * gl_WorkGroupSize.x + gl_LocalInvocationID.x);
  if (line >= lines) return;
  vec3 sample_0 = texelFetch(probe_lines, ivec2(0, line), 0).xyz,
       to_next = texelFetch(probe_lines, ivec2(1, line), 0).xyz;
  vec4 x = texelFetch(places, ivec2(0, image), 0), y = texelFetch(places, ivec2(1, image), 0),
       z = texelFetch(places, ivec2(2, image), 0);
  vec3 start = vec3(dot(x.xyz, sample_0), dot(y.xyz, sample_0), dot(z.xyz, sample_0)) + vec3(x.w, y.w, z.w);
  vec3 along = vec3(dot(x.xyz, to_next), dot(y.xyz, to_next), dot(z.xyz, to_next));
  vec3 direction = along * sides_by_dr;  // unit, along the CT's axes

  float log_intensity = 0.0;
  int k = 0;
  for (; k < samples && log_intensity > last_log_intensity; ++k) {
    vec3 at = start + float(k) * along;
#if EXACT_FILTER == 1
    vec4 here = exact_to_edge(density, at) * 32767.0;
#else
    vec4 here = textureLod(density, at, 0.0) * 32767.0;
#endif
    bool contact = float(k) < first_free_sample;
    float hu = contact && here.x < kContactAirHu ? 0.0 : here.x;
    vec3 gradient = contact ? vec3(0.0) : here.yzw * 0.125;
    float squared = dot(gradient, gradient), steepness = sqrt(squared);
    float change = min(steepness / (2.0 * max(hu + 1000.0, kAirMu)), 1.0);
    float cosine = abs(dot(direction, gradient)) / max(steepness, 1e-20);

    float intensity = exp(log_intensity);
    float reflection = log(1.0 + compression * intensity * change * change * cosine) * one_over_compressed_one;
    float echogenicity = clamp((hu - dark_hu) * one_over_hu_range, 0.0, 1.0);
    if (shadows == 1) echogenicity *= intensity;
    tell(k, line, image, echogenicity, reflection, intensity);

    log_intensity += dr_by_length * (change < 1.0 ? log(1.0 - change * change) : kNothing / dr_by_length);
  }
  atomicAdd(samples_walked, uint(k));
  for (; k < samples; ++k) tell(k, line, image, 0.0, 0.0, 0.0);
}
