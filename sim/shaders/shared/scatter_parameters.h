// What scatter.comp needs to place scatterers among the lines of one plane. The shader reads it and C++ writes it; both
// include this file. Layout std140.
#ifdef __cplusplus
#pragma once
#include <glm/vec4.hpp>
namespace insonate::gl {
using glm::ivec4;
using glm::uvec4;
using glm::vec4;
struct ScatterParameters {
#else
layout(std140, binding = 2) uniform ScatterParameters {
#endif
  vec4 probe_from_cell[3];  // steps along the three axes, mm in the probe's frame
  vec4 probe_from_corner;   // lower corner of `corner`, a cell near the probe; w: half the slice with a cell's extent, mm
  uvec4 keys;               // what a cell's hash takes a step along each axis for; w: the key of cell `corner`
  ivec4 across, up, down;   // unit steps: along a row of columns, from row to row, and along a column, where z rises

  float z_per_step;  // rise of z along a column, mm, above 0
  int steps;         // cells of a column that can lie in the slice
  float quanta;      // of the fixed-point numbers, per unit
  int first_row;     // index of the plane's first line in the buffer

  float apex_mm;             // as LineFan (sim/probe/probe.h)
  float first_across;        // of line 0, rad or mm
  float lines_across;        // lines per rad or mm
  float face_of_outer_line;  // the cosine of its angle

  float slice_half;  // in thicknesses
  float steering_sine, steering_cosine;  // of LineFan::steering
  int unused;

  uvec4 phase_steps;  // of sim/model/compounding.h; w: the phase at the lower corner of `corner`
#ifdef __cplusplus
};
}  // namespace insonate::gl
#else
};
#endif
