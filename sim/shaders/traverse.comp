// Model S along the scan lines.

layout(local_size_x = GROUP) in;

#include "shared/line_sample.glsl"
#include "shared/rows.glsl"
#include "shared/walk_by_invocation.glsl"

void main() {
  int index = invocation_in_rows();
  if (index >= line_count()) return;
#if SLICE_PLANES == 1
  walk(0, index);
#else
  for (int slice_plane = 0; slice_plane < SLICE_PLANES; ++slice_plane) walk(slice_plane, index);
#endif
  atomicAdd(samples_walked, walked);
  atomicAdd(normals_taken, normals);
}
