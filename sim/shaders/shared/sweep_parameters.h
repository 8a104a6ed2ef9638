// The parameters of the scan conversion of a sweep to a volume: read by its shader and written by C++, which both
// include this file. std140: every group of four scalars below fills one 16-byte row.
#ifdef __cplusplus
#pragma once
namespace insonate::gl {
struct SweepParameters {
#else
layout(std140, binding = 0) uniform SweepParameters {
#endif
  int planes;
  int lines;    // a plane
  int samples;  // a line
  int probe_kind;  // ProbeKind

  int width;  // of the volume, voxels
  int height;
  int depth;
  float samples_per_mm;

  float depth_mm;            // along the lines
  float face_width_mm;       // linear
  float apex_behind_mm;      // curvilinear and phased: how far behind the face's middle the lines meet
  float field_of_view;       // curvilinear and phased, radians
#ifdef __cplusplus
};
}  // namespace insonate::gl
#else
};
#endif
