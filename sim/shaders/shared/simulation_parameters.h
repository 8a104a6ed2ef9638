// The parameters of the simulation's stages: read by the shaders and written by C++, which both include this file.
// std140: every group of four scalars below fills one 16-byte row.
#ifdef __cplusplus
#pragma once
#include <glm/vec4.hpp>
namespace insonate::gl {
using glm::vec4;
struct SimulationParameters {
#else
layout(std140, binding = 0) uniform SimulationParameters {
#endif
  int lines;    // N, of a plane
  int samples;  // D
  int width;    // of the picture, pixels
  int height;

  float r_min_mm;
  float dr_mm;
  float half_reflection_length;  // l/2 in samples
  float reflection_exponent;     // dr/l

  float absorption_per_sample;  // f dr/100 ln 10: times dB/(cm MHz), the natural logarithm that a sample takes
  float coupled_mm;
  float least_alpha_with_normal;  // a weaker interface's tilt is not looked at
  float clutter_share;            // of the mean echo from the same depth; 0 for none

  float face_reflection;
  int two_way;  // 1: T = I^2
  float blend;  // b
  float fixed_level;

  float reflection_exponent_px;  // -1/(2 s^2) of the smoothing's Gaussians, s in pixels
  float transmission_exponent_px;
  float noise_level;  // mean of the electronic noise in units of U; 0 for none
  float gain_db;

  float dynamic_range_db;  // beta
  float clutter_kept;      // e^(-dr/kClutterTail_mm), see sim/model/noise.h
  float turn_kept;         // e^(-dr/kTurn_mm), see sim/model/refraction.h
  float turn_per_step;     // dr/(l kTurn_rad)

  float turn_loss;  // dr/kTurn_mm
  float slice_thickness_mm;
  float slice_spread;  // of the slice's thickness, a mm from its focus
  float elevation_focus_mm;

  int planes;       // whose lines are worked on together, one after the other: 1 for a picture
  int first_plane;  // of a sweep's, the first of these
  int noise_step;   // lines that the noise is shifted by from a plane to the next
  int unused_1;     // std140: a row has 16 bytes

  vec4 tgc_db[2];  // at 8 depths from the face to full depth
#ifdef __cplusplus
};
}  // namespace insonate::gl
#else
};
#endif
