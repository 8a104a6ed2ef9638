// LC2 of an image: its parts' sums put together, then the share of the ultrasound image's variance that the two terms
// and a constant explain.

layout(local_size_x = 8) in;

#include "shared/wein_parameters.h"

layout(binding = 0) uniform sampler2D sums;  // as lc2_parts.comp writes them
layout(std430, binding = 0) writeonly buffer Similarities { float similarity[]; };

const float kLeastVariance = 1e-10;  // of a term: kLeastTermDeviation squared

void main() {
  int image = int(gl_GlobalInvocationID.x);
  if (image >= images) return;
  float count = 0.0;
  vec3 mean = vec3(0.0), squares = vec3(0.0), products = vec3(0.0);
  int parts = textureSize(sums, 0).x / 3;
  for (int i = 0; i < parts; ++i) {
    vec4 part = texelFetch(sums, ivec2(3 * i, image), 0);
    float both = max(count + part.w, 1.0), weight = count * part.w / both;
    vec3 apart = part.xyz - mean;
    squares += texelFetch(sums, ivec2(3 * i + 1, image), 0).xyz + weight * apart * apart;
    products += texelFetch(sums, ivec2(3 * i + 2, image), 0).xyz + weight * apart * apart.yzx;
    mean += apart * (part.w / both);
    count += part.w;
  }
  float least = kLeastVariance * count;
  float uu = squares.x, ee = squares.y, rr = squares.z, ue = products.x, er = products.y, ru = products.z;
  float explained = 0.0;
  if (ee >= least) {  // E, and what of R is not E's
    explained = ue * ue / ee;
    ru -= er * ue / ee;
    rr -= er * er / ee;
  }
  if (rr >= least) explained += ru * ru / rr;
  similarity[first + image] = uu > 0.0 ? clamp(explained / uu, 0.0, 1.0) : 0.0;
}
