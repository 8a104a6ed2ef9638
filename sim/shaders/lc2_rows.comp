// LC2's sums over one row of one image: of the ultrasound image u and the terms E and R, which are converted from the
// scan lines on the way. Kept as means and products of differences, which single precision can hold: sums of squares
// less squares of sums would leave nothing of a flat image.

layout(local_size_x = 8) in;

#include "shared/wein_parameters.h"
#include "shared/wein_scan.glsl"

layout(binding = 1) uniform sampler2D pixels;  // line, sample, u, 1 where the pixel counts
layout(std430, binding = 0) readonly buffer Rows { ivec2 counted[]; };  // a row: first pixel that counts, behind the last
layout(binding = 0, rgba32f) writeonly uniform image2D sums;  // a row an image, three texels a row of it

void main() {
  int index = int(gl_GlobalInvocationID.x);
  if (index >= height * images) return;
  int y = index % height, image = index / height;
  ivec2 range = counted[y];
  vec3 origin = vec3(0.0), sum = vec3(0.0), squares = vec3(0.0), products = vec3(0.0);
  float count = 0.0;
  for (int x = range.x; x < range.y; ++x) {
    vec4 at = texelFetch(pixels, ivec2(x, y), 0);
    vec3 value = vec3(at.z, terms_at(at.xy, image));
    if (x == range.x) origin = value;  // which counts
    value = at.w * (value - origin);
    count += at.w;
    sum += value;
    squares += value * value;
    products += value * value.yzx;
  }
  vec3 mean = sum / max(count, 1.0);
  imageStore(sums, ivec2(3 * y, image), vec4(origin + mean, count));
  imageStore(sums, ivec2(3 * y + 1, image), vec4(squares - sum * mean, 0.0));          // uu, EE, RR
  imageStore(sums, ivec2(3 * y + 2, image), vec4(products - sum * mean.yzx, 0.0));     // uE, ER, Ru
}
