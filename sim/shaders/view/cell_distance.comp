// The distances from the cells of a CT to the nearest one where something can be visible, one axis after the other: what
// distance_map() computes on the processor (sim/view/body/distance_map.h).
//
// Along an axis a distance becomes the least, over the cells on both sides, of the larger of the steps to a cell and the
// distance there. Beyond the box stands the cell at its end, which is nearer and has been seen before.
//
// Reads what is busy (AXIS 0), or the distances along the axes before. Writes distances. The C++ side defines AXIS and
// MOST_DISTANCE. Dispatch: one invocation per cell.
layout(local_size_x = 8, local_size_y = 4, local_size_z = 4) in;

layout(binding = 0) uniform usampler3D before;
layout(binding = 0, r8ui) uniform writeonly restrict uimage3D distances;

int distance_before(ivec3 cell) {
  int value = int(texelFetch(before, clamp(cell, ivec3(0), textureSize(before, 0) - 1), 0).x);
#if AXIS == 0
  return value != 0 ? 0 : MOST_DISTANCE;
#else
  return value;
#endif
}

void main() {
  ivec3 cell = ivec3(gl_GlobalInvocationID), step = ivec3(AXIS == 0, AXIS == 1, AXIS == 2);
  if (any(greaterThanEqual(cell, textureSize(before, 0)))) return;
  int least = distance_before(cell);
  for (int apart = 1; apart < least; ++apart) {
    int there = min(distance_before(cell - apart * step), distance_before(cell + apart * step));
    least = min(least, max(apart, there));
  }
  imageStore(distances, cell, uvec4(least));
}
