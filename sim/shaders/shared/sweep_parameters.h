// The parameters of the scan conversion of a sweep's planes to slices of a volume. The shader reads them and C++ writes
// them; both include this file. Layout std140: each group of four scalars below fills one 16-byte row.
#ifdef __cplusplus
#pragma once
namespace insonate::gl {
struct SweepParameters {
#else
layout(std140, binding = 1) uniform SweepParameters {
#endif
  int planes;   // of this part of the sweep
  int lines;    // per plane
  int samples;  // per line
  int probe_kind;  // ProbeKind

  int width;  // of the volume, voxels
  int height;
  int first_slice;
  int is_first_part;  // 1: also write the voxels that do not lie between any of these planes

  float depth_mm;        // along the lines
  float face_width_mm;   // linear probes
  float apex_behind_mm;  // curvilinear and phased probes: distance of the lines' common point behind the face's middle
  float field_of_view;   // curvilinear and phased probes, radians
#ifdef __cplusplus
};
}  // namespace insonate::gl
#else
};
#endif
