// Traversal of model W along a scan line of several images of a chunk, with the symbols of
// sim/wein/wein_settings.h:
//
//     I(r + dr) = I(r) dT^(dr/l),  I(face) = 1
//     R = ln(1 + a I dR) / ln(1 + a)
//     E = clamp((HU - dark_hu) / (bright_hu - dark_hu), 0, 1),  times I with shadows
//
// Reads the volume, the lines and the poses. The gradient is stored with the density, so a sample costs one fetch.
// Writes per sample either both terms, E and R, or with GREY the grey level that a picture makes of them, which takes
// half the memory.
// Dispatch: runs of IMAGES_PER_INVOCATION images x lines / GROUP work groups of GROUP. An invocation traverses one line of the
// images of its run, one after the other. Consecutive work groups traverse the same few lines in one image after the
// other. Poses of a search lie close together, so the voxels are still in the cache.
//
// Samples are computed in pairs, so that a processor computes one while the other waits for a division. Where images
// are interleaved in the scan, a pair is the same sample of two images. Elsewhere it is two neighbouring samples on the
// line. One store writes a texel of interleaved images, that is one pair's terms or two pairs' greys. Elsewhere it
// writes the result of one pair. Where the device has 64-bit integers, the store is one scalar: llvmpipe takes as long
// again for each component of a vector.

#ifdef GL_ARB_gpu_shader_int64
#extension GL_ARB_gpu_shader_int64 : enable
#define Words uint64_t
#define words_of packUint2x32
#else
#define Words uvec2
#define words_of uvec2
#endif

layout(local_size_x = GROUP) in;

#include "shared/model_constants.h"
#include "wein/wein_parameters.h"
#include "shared/exact_filter.glsl"

layout(binding = 0) uniform sampler3D density;  // (HU, gradient along the CT's axes in eighths of HU) / 32767
layout(binding = 1) uniform sampler2D probe_lines;  // one row per line, probe's frame, mm: sample 0, step to the next
layout(binding = 2) uniform sampler2D places;       // one row per image: the rows of texture_from_probe
#ifdef BENT
// One row per image: how far the nodes of its scan lines are moved, in the volume's texture. BEND_ACROSS nodes lie
// evenly from the first line to the last; the next BEND_ACROSS lie BEND_SAMPLES samples deeper. Lines are straight in
// between.
layout(binding = 3) uniform sampler2D bends;
#endif
#if GREY == 1 && INTERLEAVED == 1
#define Stored uint
#else
#define Stored Words
#endif
layout(std430, binding = 0) writeonly buffer Scan { Stored scan[]; };  // as wein/wein_scan.glsl reads it
layout(std430, binding = 1) buffer Counter { uint samples_traversed; };  // of one call
#ifdef INTENSITY
layout(binding = 1, r32f) writeonly uniform image2D intensities;  // of the first image
#endif

const float kNothing = -1e6;  // stands for ln 0, what total reflection transmits

// A scan line of one image, in coordinates of the volume's texture.
struct Line {
  vec3 start, along;  // sample 0, step to the next
  vec3 direction;     // unit if the pose is rigid, along the CT's axes
};

// The terms of a pair of samples.
struct Terms {
  vec2 echogenicity, reflection, intensity;
};

const int kSamplesAPair = INTERLEAVED == 1 ? 2 : 1, kImagesAPair = 2 / kSamplesAPair;
const int kPairs = GREY == 1 && INTERLEAVED == 4 ? 2 : 1, kImages = kPairs * kImagesAPair;  // traversed at once

int line;

Line line_of(int image) {
  vec3 sample_0 = texelFetch(probe_lines, ivec2(0, line), 0).xyz,
       to_next = texelFetch(probe_lines, ivec2(1, line), 0).xyz;
  vec4 x = texelFetch(places, ivec2(0, image), 0), y = texelFetch(places, ivec2(1, image), 0),
       z = texelFetch(places, ivec2(2, image), 0);
  vec3 start = vec3(dot(x.xyz, sample_0), dot(y.xyz, sample_0), dot(z.xyz, sample_0)) + vec3(x.w, y.w, z.w);
  vec3 along = vec3(dot(x.xyz, to_next), dot(y.xyz, to_next), dot(z.xyz, to_next));
  return Line(start, along, along * sides_by_dr);
}

#ifdef BENT
// Returns a line as it runs from sample k on, the first of a segment, to the segment's end.
Line bent(Line straight, int image, int k) {
  float across = float(line) * (float(BEND_ACROSS - 1) / float(max(lines - 1, 1)));
  int left = min(int(across), BEND_ACROSS - 2), node = k / BEND_SAMPLES * BEND_ACROSS + left;
  float share = across - float(left);
  vec3 here = mix(texelFetch(bends, ivec2(node, image), 0).xyz, texelFetch(bends, ivec2(node + 1, image), 0).xyz, share);
  node += BEND_ACROSS;
  vec3 next = mix(texelFetch(bends, ivec2(node, image), 0).xyz, texelFetch(bends, ivec2(node + 1, image), 0).xyz, share);
  vec3 slope = (next - here) / float(BEND_SAMPLES), along = straight.along + slope;
  return Line(straight.start + here - float(k) * slope, along, along * sides_by_dr);
}
#endif

vec4 density_at(Line of_image, float k) {
  vec3 at = of_image.start + k * of_image.along;
#if EXACT_FILTER == 1
  return exact_to_edge(density, at) * 32767.0;
#else
  return textureLod(density, at, 0.0) * 32767.0;
#endif
}

// Returns where a line leaves the CT and its margin of air, counted in samples; -1 where it misses them.
float last_in_ct(Line of_image) {
  vec3 along = mix(of_image.along, vec3(1e-12), lessThan(abs(of_image.along), vec3(1e-12)));
  vec3 low = -of_image.start / along, high = (1.0 - of_image.start) / along;
  vec3 entering = min(low, high), leaving = max(low, high);
  float first = max(max(entering.x, entering.y), entering.z), last = min(min(leaving.x, leaving.y), leaving.z);
  return first <= last ? last : -1.0;
}

// ln(1 - share) without the cancellation in 1 - share. Small shares take its series, because thousands may add up.
vec2 log_of_rest(vec2 share) {
  vec2 series = -share * (1.0 + share * (0.5 + share * (1.0 / 3.0)));
  return mix(log(1.0 - share), series, lessThan(share, vec2(0.01)));
}

// Returns the terms of the pair whose first sample is k. Advances ln I to the next pair: per image, or the same value
// twice for a single image.
Terms terms_of(Line one, Line other, int k, inout vec2 log_intensity) {
  vec2 steps = vec2(k, k + kSamplesAPair - 1);
  vec4 here = density_at(one, steps.x), there = density_at(other, steps.y);
  vec3 gradient = here.yzw * 0.125, gradient_there = there.yzw * 0.125;
  vec2 steepness = sqrt(vec2(dot(gradient, gradient), dot(gradient_there, gradient_there)));
  vec2 across = abs(vec2(dot(one.direction, gradient), dot(other.direction, gradient_there)));
  vec2 cosine = across / max(steepness, 1e-20), hu = vec2(here.x, there.x);

  bvec2 contact = lessThan(steps, vec2(first_free_sample));
  vec2 water = clamp((kCouplingTissue_hu - hu) / (kCouplingTissue_hu - kCouplingAir_hu), 0.0, 1.0);
  hu = mix(hu, hu * (1.0 - water), contact);
  vec2 change = mix(min(steepness / (2.0 * max(hu + 1000.0, kAirMu)), 1.0), vec2(0.0), contact);

  vec2 log_passed = mix(log_of_rest(change * change) * dr_by_length, vec2(kNothing), equal(change, vec2(1.0)));
  vec2 before = log_intensity;
  if (kSamplesAPair == 2) before.y += log_passed.x;
  log_intensity = before + log_passed;
  if (kSamplesAPair == 2) log_intensity.x = log_intensity.y;

  vec2 intensity = exp(before);
  vec2 reflection = log(1.0 + compression * intensity * change * change * cosine) * one_over_compressed_one;
  vec2 echogenicity = clamp((hu - dark_hu) * one_over_hu_range, 0.0, 1.0);
  if (shadows == 1) echogenicity *= intensity;
  return Terms(echogenicity, reflection, intensity);
}

uint greys_of(Terms terms) { return packUnorm2x16(mix(terms.echogenicity, terms.reflection, reflection_share)); }

// Traverses a line of kImages images from `image` on until no sound is left in any. Returns the number of samples
// traversed, over all these images.
int traverse_line(int image) {
  Line ways[2 * kPairs];
  float last = first_free_sample;  // nearer to the face, air outside the body counts as water
  for (int i = 0; i < 2 * kPairs; ++i) {
    ways[i] = line_of(min(image + i / kSamplesAPair, images - 1));
    last = max(last, last_in_ct(ways[i]));
  }
#if defined(INTENSITY) || defined(BENT)
  int end = samples;  // the intensity is not 0 behind the CT, and a bent line may come back to it
#else
  int end = int(min(last + 2.0, float(samples)));
#endif
#ifdef BENT
  Line straight[2 * kPairs] = ways;
#endif
  vec2 log_intensity[kPairs];
  float most = 0.0;
  for (int i = 0; i < kPairs; ++i) log_intensity[i] = vec2(0.0);

  int at = (image / kImages * lines + line) * (row_samples / kSamplesAPair), k = 0;
  for (; k < end && most > last_log_intensity; k += kSamplesAPair) {
#ifdef BENT
    if (k % BEND_SAMPLES == 0)
      for (int i = 0; i < 2 * kPairs; ++i) ways[i] = bent(straight[i], min(image + i / kSamplesAPair, images - 1), k);
#endif
    Terms terms[kPairs];
    most = kNothing;
    for (int i = 0; i < kPairs; ++i) {
      terms[i] = terms_of(ways[2 * i], ways[2 * i + 1], k, log_intensity[i]);
      most = max(most, max(log_intensity[i].x, log_intensity[i].y));
    }
#if GREY == 0
    scan[at++] = words_of(uvec2(packUnorm2x16(vec2(terms[0].echogenicity.x, terms[0].reflection.x)),
                                packUnorm2x16(vec2(terms[0].echogenicity.y, terms[0].reflection.y))));
#elif INTERLEAVED == 1
    scan[at++] = greys_of(terms[0]);
#else
    scan[at++] = words_of(uvec2(greys_of(terms[0]), greys_of(terms[1])));
#endif
#ifdef INTENSITY
    imageStore(intensities, ivec2(k, line), vec4(terms[0].intensity.x));
    imageStore(intensities, ivec2(k + 1, line), vec4(terms[0].intensity.y));
#endif
  }
  int traversed = min(k, samples) * min(kImages, images - image);
  for (; k < samples; k += kSamplesAPair) scan[at++] = Stored(0u);
  return traversed;
}

void main() {
  int first_image = int(gl_WorkGroupID.x) * IMAGES_PER_INVOCATION, end = min(first_image + IMAGES_PER_INVOCATION, images), traversed = 0;
  line = int(gl_WorkGroupID.y * gl_WorkGroupSize.x + gl_LocalInvocationID.x);
  if (line >= lines) return;
  for (int image = first_image; image < end; image += kImages) traversed += traverse_line(image);
  atomicAdd(samples_traversed, uint(traversed));
}
