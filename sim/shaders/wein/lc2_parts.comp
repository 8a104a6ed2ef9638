// Sums for LC2 over one part of an image's pixels: of the ultrasound image u and of the terms E and R, which the stage
// converts from the scan lines. It keeps means and products of differences, which single precision can hold. Sums of
// squares minus squares of sums would cancel to nothing for a flat image.
//
// Reads the scan, the table of pixels and the ultrasound images' values. Simulated image i of a call belongs to
// ultrasound image first_ultrasound + i modulo `ultrasounds`. Writes three texels per part and image.
// Dispatch: parts x groups of images invocations, in work groups of GROUP x 1. An invocation sums one part of all
// images that share the scan's texels.

layout(local_size_x = GROUP) in;

#include "wein/wein_parameters.h"
#include "wein/wein_scan.glsl"

layout(binding = 2) uniform samplerBuffer ultrasound;  // per ultrasound image and entry of the pixels' table
layout(binding = 0, rgba32f) writeonly uniform image2D sums;  // one row per image, three texels per part

const float kNotCompared = 1e29;  // values above it do not count

struct Sums {
  vec3 origin, sum, squares, products;  // of differences from `origin`, the first pixel's values
  float count;
};

void main() {
  int column = int(gl_GlobalInvocationID.x), group = int(gl_WorkGroupID.y);
  int entries = textureSize(pixels), length = steps(), columns_of_table = entries / length;
  Sums of[interleaved_terms];
  int values_at[interleaved_terms];
  for (int j = 0; j < interleaved_terms; ++j) {
    of[j] = Sums(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
    int of_ultrasound = first_ultrasound + (first + group * interleaved_terms + j) % ultrasounds;
    values_at[j] = of_ultrasound * entries + column;
  }
  for (int i = 0; i < length; ++i) {
    ivec4 pixel = pixel_at(i);
    vec4 terms = scanned_at(pixel, group);
    for (int j = 0; j < interleaved_terms; ++j) {
      float u = texelFetch(ultrasound, values_at[j] + i * columns_of_table).x, counts = u < kNotCompared ? 1.0 : 0.0;
      vec3 value = vec3(counts * u, j == 0 ? terms.xy : terms.zw);
      if (i == 0) of[j].origin = value;
      value = counts * (value - of[j].origin);
      of[j].count += counts;
      of[j].sum += value;
      of[j].squares += value * value;
      of[j].products += value * value.yzx;
    }
  }
  for (int j = 0; j < interleaved_terms; ++j) {
    int image = group * interleaved_terms + j;
    if (image >= images) break;
    vec3 sum = of[j].sum, mean = sum / max(of[j].count, 1.0);
    imageStore(sums, ivec2(3 * column, image), vec4(of[j].origin + mean, of[j].count));
    imageStore(sums, ivec2(3 * column + 1, image), vec4(of[j].squares - sum * mean, 0.0));       // uu, EE, RR
    imageStore(sums, ivec2(3 * column + 2, image), vec4(of[j].products - sum * mean.yzx, 0.0));  // uE, ER, Ru
  }
}
