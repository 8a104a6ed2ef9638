// The parameters of the scan conversion of a sweep's planes to slices of a volume: read by its shader and by C++, which
// writes them; both include this file. std140: every group of four scalars below fills one 16-byte row.
#ifdef __cplusplus
#pragma once
namespace insonate::gl {
struct SweepParameters {
#else
layout(std140, binding = 1) uniform SweepParameters {
#endif
  int planes;   // that are at hand, of a sweep's
  int lines;    // a plane
  int samples;  // a line
  int probe_kind;  // ProbeKind

  int width;  // of the volume, voxels
  int height;
  int first_slice;
  int is_first_part;  // 1: the voxels between none of these planes are written too

  float depth_mm;        // along the lines
  float face_width_mm;   // linear
  float apex_behind_mm;  // curvilinear and phased: how far behind the face's middle the lines meet
  float field_of_view;   // curvilinear and phased, radians
#ifdef __cplusplus
};
}  // namespace insonate::gl
#else
};
#endif
