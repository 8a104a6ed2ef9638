// Traversal of model S along the scan lines. From Kutter, Shams, Navab 2009, with the symbols of sim/model/stages.h:
//
//     alpha(r) = ((Z(r + l/2) - Z(r - l/2)) / (Z(r + l/2) + Z(r - l/2)))^2          (1)
//     I(r + dr) = I(r) (1 - alpha(r))^(dr/l) 10^(-a f dr/100),  I(0) = 1            (5)
//     R = alpha I^2 |d . n|                                                         (3)
//
// The last factor of (5) is not in the paper. sim/model/refraction.h adds the loss by refraction.
//
// Reads the volume, the tissue table, the scatterers and the placed lines. Writes I, R and the scatterers' echo,
// and for reverberation I and R of the slice's middle plane.
// Dispatch: one invocation per line in rows of work groups of GROUP or, with GROUP_PER_LINE, one work group of GROUP
// per line (shared/rows.glsl). sim/gl/work_division.h gives the reasons for either.

layout(local_size_x = GROUP) in;

#include "shared/line_sample.glsl"
#include "shared/rows.glsl"
#if GROUP_PER_LINE == 1
#include "shared/traverse_by_group.glsl"
#else
#include "shared/traverse_by_invocation.glsl"
#endif

void main() {
  int index = GROUP_PER_LINE == 1 ? group_in_rows() : invocation_in_rows();
  if (index >= line_count()) return;  // the same for all invocations of a group that traverses one line
#if SLICE_PLANES == 1
  traverse_line(0, index);
#else
  for (int slice_plane = 0; slice_plane < SLICE_PLANES; ++slice_plane) traverse_line(slice_plane, index);
#endif
  atomicAdd(samples_traversed, traversed);
  atomicAdd(normals_taken, normals);
}
