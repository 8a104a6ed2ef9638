// LC2's sums over a part of one image's pixels, an invocation a part: of the ultrasound image u and the terms E and R,
// which are converted from the scan lines on the way. Kept as means and products of differences, which single precision
// can hold: sums of squares less squares of sums would leave nothing of a flat image.

layout(local_size_x = GROUP) in;

#include "shared/wein_parameters.h"
#include "shared/wein_scan.glsl"

layout(binding = 0, rgba32f) writeonly uniform image2D sums;  // a row an image, three texels a part

void main() {
  int column = int(gl_GlobalInvocationID.x), image = int(gl_WorkGroupID.y);
  vec3 origin = vec3(0.0), sum = vec3(0.0), squares = vec3(0.0), products = vec3(0.0);
  float count = 0.0;
  int length = steps();
  for (int i = 0; i < length; ++i) {
    ivec4 pixel = pixel_at(i);  // its w: u
    float counts = pixel.x < 0 ? 0.0 : 1.0;
    vec3 value = vec3(intBitsToFloat(pixel.w), scanned_at(pixel, image));
    if (i == 0) origin = value;
    value = counts * (value - origin);
    count += counts;
    sum += value;
    squares += value * value;
    products += value * value.yzx;
  }
  vec3 mean = sum / max(count, 1.0);
  imageStore(sums, ivec2(3 * column, image), vec4(origin + mean, count));
  imageStore(sums, ivec2(3 * column + 1, image), vec4(squares - sum * mean, 0.0));       // uu, EE, RR
  imageStore(sums, ivec2(3 * column + 2, image), vec4(products - sum * mean.yzx, 0.0));  // uE, ER, Ru
}
