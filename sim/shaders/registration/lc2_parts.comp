// Sums for LC2 over one part of an image's pixels: of the ultrasound image u and of the terms E and R, which the stage
// converts from the scan lines. It keeps means and products of differences, which single precision can hold. Sums of
// squares minus squares of sums would cancel to nothing for a flat image.
//
// Reads the scan and the table of pixels. Writes three texels per part and image.
// Dispatch: parts x groups of images invocations, in work groups of GROUP x 1. An invocation sums one part of all
// images that share the scan's texels.

layout(local_size_x = GROUP) in;

#include "shared/wein_parameters.h"
#include "shared/wein_scan.glsl"

layout(binding = 0, rgba32f) writeonly uniform image2D sums;  // one row per image, three texels per part

struct Sums {
  vec3 origin, sum, squares, products;  // of differences from `origin`, the first pixel's values
};

void main() {
  int column = int(gl_GlobalInvocationID.x), group = int(gl_WorkGroupID.y);
  Sums of[interleaved_terms];
  for (int j = 0; j < interleaved_terms; ++j) of[j] = Sums(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  float count = 0.0;
  int length = steps();
  for (int i = 0; i < length; ++i) {
    ivec4 pixel = pixel_at(i);  // w: u, as a float's bits
    float counts = pixel.x < 0 ? 0.0 : 1.0, u = intBitsToFloat(pixel.w);
    vec4 terms = scanned_at(pixel, group);
    count += counts;
    for (int j = 0; j < interleaved_terms; ++j) {
      vec3 value = vec3(u, j == 0 ? terms.xy : terms.zw);
      if (i == 0) of[j].origin = value;
      value = counts * (value - of[j].origin);
      of[j].sum += value;
      of[j].squares += value * value;
      of[j].products += value * value.yzx;
    }
  }
  for (int j = 0; j < interleaved_terms; ++j) {
    int image = group * interleaved_terms + j;
    if (image >= images) break;
    vec3 sum = of[j].sum, mean = sum / max(count, 1.0);
    imageStore(sums, ivec2(3 * column, image), vec4(of[j].origin + mean, count));
    imageStore(sums, ivec2(3 * column + 1, image), vec4(of[j].squares - sum * mean, 0.0));       // uu, EE, RR
    imageStore(sums, ivec2(3 * column + 2, image), vec4(of[j].products - sum * mean.yzx, 0.0));  // uE, ER, Ru
  }
}
