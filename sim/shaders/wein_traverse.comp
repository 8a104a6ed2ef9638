// Model W along a scan line, an invocation a line, of several images of a chunk one after the other: of each sample
// either both terms, echogenicity and reflection, or the grey that a picture makes of them, which takes half the room.
// The gradient is stored with the density, so a sample costs one fetch. Groups follow each other image by image along the
// same few lines: poses of a search lie close together, so the voxels are still in the cache. Where the scan's texels
// hold four images' greys, lines of two images are walked along at once, because a word has room for two.

layout(local_size_x = GROUP) in;

#include "shared/wein_parameters.h"
#include "shared/exact_filter.glsl"

layout(binding = 0) uniform sampler3D density;  // (HU, gradient along the CT's axes in eighths of HU) / 32767
layout(binding = 1) uniform sampler2D probe_lines;  // a row a line, probe's frame, mm: sample 0, the way to the next
layout(binding = 2) uniform sampler2D places;       // a row an image: the rows of texture_from_probe
layout(std430, binding = 0) writeonly buffer Scan { uint scan[]; };  // as shared/wein_scan.glsl reads it, 16 bits each
layout(std430, binding = 1) buffer Counter { uint samples_walked; };  // of a call
#ifdef INTENSITY
layout(binding = 1, r32f) writeonly uniform image2D intensities;  // of the first image
#endif

const float kAirMu = 1.2;
const float kContactAirHu = -300.5;
const float kNothing = -1e6;  // the logarithm of what total reflection lets pass, in effect

struct Walk {
  vec3 start, along;  // of the line, in the volume's texture: sample 0, the way to the next
  vec3 direction;     // unit, along the CT's axes
  float log_intensity;
};

int line;

Walk at_start(int image) {
  vec3 sample_0 = texelFetch(probe_lines, ivec2(0, line), 0).xyz,
       to_next = texelFetch(probe_lines, ivec2(1, line), 0).xyz;
  vec4 x = texelFetch(places, ivec2(0, image), 0), y = texelFetch(places, ivec2(1, image), 0),
       z = texelFetch(places, ivec2(2, image), 0);
  vec3 start = vec3(dot(x.xyz, sample_0), dot(y.xyz, sample_0), dot(z.xyz, sample_0)) + vec3(x.w, y.w, z.w);
  vec3 along = vec3(dot(x.xyz, to_next), dot(y.xyz, to_next), dot(z.xyz, to_next));
  return Walk(start, along, along * sides_by_dr, 0.0);
}

// E and R of the sample that the walk has come to; goes on to the next.
vec2 terms_of(inout Walk walk, int k) {
  vec3 at = walk.start + float(k) * walk.along;
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
  float cosine = abs(dot(walk.direction, gradient)) / max(steepness, 1e-20);

  float intensity = exp(walk.log_intensity);
  float reflection = log(1.0 + compression * intensity * change * change * cosine) * one_over_compressed_one;
  float echogenicity = clamp((hu - dark_hu) * one_over_hu_range, 0.0, 1.0);
  if (shadows == 1) echogenicity *= intensity;
#ifdef INTENSITY
  imageStore(intensities, ivec2(k, line), vec4(intensity));
#endif
  walk.log_intensity += dr_by_length * (change < 1.0 ? log(1.0 - change * change) : kNothing / dr_by_length);
  return vec2(echogenicity, reflection);
}

float grey_of(inout Walk walk, int k) {
  vec2 terms = terms_of(walk, k);
  return mix(terms.x, terms.y, reflection_share);
}

// What a word of the scan holds from sample k on: both terms, the greys of two samples, or those of two images, of which
// the other is a neighbour's.
#if GREY == 0
const int kSamplesAWord = 1, kImagesAWord = 1, kImagesATexel = terms_abreast;
uint word_of(inout Walk one, inout Walk other, int k) { return packUnorm2x16(terms_of(one, k)); }
#elif ABREAST == 1
const int kSamplesAWord = 2, kImagesAWord = 1, kImagesATexel = 1;
uint word_of(inout Walk one, inout Walk other, int k) {
  float first = grey_of(one, k);
  return packUnorm2x16(vec2(first, grey_of(one, k + 1)));
}
#else
const int kSamplesAWord = 1, kImagesAWord = 2, kImagesATexel = greys_abreast;
uint word_of(inout Walk one, inout Walk other, int k) {
  float first = grey_of(one, k);
  return packUnorm2x16(vec2(first, grey_of(other, k)));
}
#endif
const int kStride = kImagesATexel > 1 ? 2 : 1;  // from a line's word to its next

// How many samples were walked before nothing was left.
int walk(int image) {
  Walk one = at_start(image), other = at_start(min(image + kImagesAWord, images) - 1);
  if (kImagesAWord == 1) other.log_intensity = kNothing;  // it stays behind
  int k = 0, row = (image / kImagesATexel * lines + line) * (row_samples / kSamplesAWord),
      word = row * kStride + image % kImagesATexel / kImagesAWord;
  for (; k < samples && max(one.log_intensity, other.log_intensity) > last_log_intensity; k += kSamplesAWord) {
    scan[word] = word_of(one, other, k);
    word += kStride;
  }
  int walked = min(k, samples) * min(kImagesAWord, images - image);
  for (; k < samples; k += kSamplesAWord) {
    scan[word] = 0u;
    word += kStride;
  }
  return walked;
}

void main() {
  int first_image = int(gl_WorkGroupID.x) * IMAGES_IN_TURN, end = min(first_image + IMAGES_IN_TURN, images), walked = 0;
  line = int(gl_WorkGroupID.y * gl_WorkGroupSize.x + gl_LocalInvocationID.x);
  if (line >= lines) return;
  for (int image = first_image; image < end; image += kImagesAWord) walked += walk(image);
  atomicAdd(samples_walked, uint(walked));
}
