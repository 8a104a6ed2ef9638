// LC2 of an image: the share of the ultrasound image's variance that the two terms and a constant explain
// (sim/wein/wein_reference.h). It follows from the sums of all parts combined or, where the parts are patches,
// from each part by itself.
//
// Reads the sums of lc2_parts.comp. Writes one similarity per image, 0 to 1. With BY_PATCH it writes what each patch
// contributes to it.
// Dispatch: one invocation per image of the chunk, in work groups of GROUP.

layout(local_size_x = GROUP) in;

#include "wein/wein_parameters.h"

layout(binding = 0) uniform sampler2D sums;  // as lc2_parts.comp writes them
layout(std430, binding = 0) buffer Similarities { float similarity[]; };

const float kMinVariance = 1e-10;  // of a term: kMinTermDeviation squared

// Returns how much of uu is explained, from the sums of squares (uu, EE, RR) and products (uE, ER, Ru).
float explained_by(vec3 squares, vec3 products, float count) {
  float least = kMinVariance * count;
  float ee = squares.y, rr = squares.z, ue = products.x, er = products.y, ru = products.z;
  float explained = 0.0;
  if (ee >= least) {  // E, and the part of R that is orthogonal to E
    explained = ue * ue / ee;
    ru -= er * ue / ee;
    rr -= er * er / ee;
  }
  if (rr >= least) explained += ru * ru / rr;
  return clamp(explained, 0.0, squares.x);
}

void main() {
  int image = int(gl_GlobalInvocationID.x);
  if (image >= images) return;
  float count = 0.0, explained = 0.0, variance = 0.0;
  vec3 mean = vec3(0.0), squares = vec3(0.0), products = vec3(0.0);
  int parts = textureSize(sums, 0).x / 3;
  for (int i = 0; i < parts; ++i) {
    vec4 part = texelFetch(sums, ivec2(3 * i, image), 0);
    vec3 part_squares = texelFetch(sums, ivec2(3 * i + 1, image), 0).xyz;
    vec3 part_products = texelFetch(sums, ivec2(3 * i + 2, image), 0).xyz;
    if (patches == 1) {
      float of_patch = part.w > 0.0 ? explained_by(part_squares, part_products, part.w) : 0.0;
#ifdef BY_PATCH
      similarity[(first + image) * parts + i] = of_patch;
#endif
      explained += of_patch;
      variance += part_squares.x;
      continue;
    }
    float both = max(count + part.w, 1.0), weight = count * part.w / both;
    vec3 apart = part.xyz - mean;
    squares += part_squares + weight * apart * apart;
    products += part_products + weight * apart * apart.yzx;
    mean += apart * (part.w / both);
    count += part.w;
  }
#ifdef BY_PATCH
  for (int i = 0; i < parts; ++i) similarity[(first + image) * parts + i] /= max(variance, 1e-20);
  return;
#endif
  if (patches == 0) {
    explained = explained_by(squares, products, count);
    variance = squares.x;
  }
  similarity[first + image] = variance > 0.0 ? clamp(explained / variance, 0.0, 1.0) : 0.0;
}
