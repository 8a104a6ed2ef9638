// Gain, log compression (7) and grey map of a sweep's volume:
//
//     grey = m(clamp(1 - (white_db - level) / dynamic_range_db, 0, 1)),  m the grey map
//
// With FIND_MAXIMUM, the stage instead finds the level that is white where the brightest voxel is white.
//
// Reads U and the depth of each voxel of a slab. Writes grey and 1 per voxel, or the maximum.
// Dispatch: one invocation per four voxels, in rows of work groups of 64 (shared/rows.glsl). The voxels are numbered
// through the slab.

layout(local_size_x = 64) in;

#include "shared/simulation_parameters.h"
#include "shared/grey.glsl"
#include "shared/rows.glsl"
#include "shared/time_gain.glsl"

layout(binding = 0) uniform samplerBuffer swept;              // per voxel: U, share of the imaging depth; -1 outside
layout(std430, binding = 0) buffer Maximum { uint maximum; };  // as ordered() encodes it; 0 for none
#if FIND_MAXIMUM == 0
layout(std430, binding = 1) writeonly buffer Volume { uvec2 volume[]; };  // four voxels: grey, 1 inside; packed
#endif

float level_at(int voxel) {
  vec2 value = texelFetch(swept, min(voxel, textureSize(swept) - 1)).xy;
  return value.y < 0.0 ? kOutsideFan : level_db(value.x) + gain_at_db(value.y);
}

#if FIND_MAXIMUM == 1
void serve(int quad) {
  uint most = 0u;
  for (int i = 0; i < 4; ++i) {
    float level = level_at(4 * quad + i);
    if (level != kOutsideFan) most = max(most, ordered(level));
  }
  // Few invocations find more than the maximum so far. Only these pay for the atomic operation, which may have to wait.
  if (most > maximum) atomicMax(maximum, most);
}
#else
vec2 voxel_at(int voxel, float white_db) {
  float level = level_at(voxel);
  return level == kOutsideFan ? vec2(0.0) : vec2(mapped(compressed(level, white_db)), 1.0);
}

void serve(int quad) {
  float white_db = FRAME_MAXIMUM == 1 ? level_of(maximum) : level_db(fixed_level);
  vec4 first = vec4(voxel_at(4 * quad, white_db), voxel_at(4 * quad + 1, white_db));
  vec4 second = vec4(voxel_at(4 * quad + 2, white_db), voxel_at(4 * quad + 3, white_db));
  volume[quad] = uvec2(packUnorm4x8(first), packUnorm4x8(second));
}
#endif

void main() {
  int quad = invocation_in_rows();
  if (4 * quad < textureSize(swept)) serve(quad);
}
