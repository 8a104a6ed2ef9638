// Model S along the scan lines, a line an invocation or a line a work group, as sim/gl/work_division.h says.

layout(local_size_x = GROUP) in;

#include "shared/line_sample.glsl"
#include "shared/rows.glsl"
#if GROUP_A_LINE == 1
#include "shared/walk_by_group.glsl"
#else
#include "shared/walk_by_invocation.glsl"
#endif

void main() {
  int index = GROUP_A_LINE == 1 ? group_in_rows() : invocation_in_rows();
  if (index >= line_count()) return;  // all of a group that walks along a line
#if SLICE_PLANES == 1
  walk(0, index);
#else
  for (int slice_plane = 0; slice_plane < SLICE_PLANES; ++slice_plane) walk(slice_plane, index);
#endif
  atomicAdd(samples_walked, walked);
  atomicAdd(normals_taken, normals);
}
