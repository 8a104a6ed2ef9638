// The parameters of model S's stages. The shaders read them and C++ writes them; both include this file. Layout std140:
// each group of four scalars below fills one 16-byte row.
#ifdef __cplusplus
#pragma once
#include <glm/vec4.hpp>
namespace insonate::gl {
using glm::vec4;
struct SimulationParameters {
#else
layout(std140, binding = 0) uniform SimulationParameters {
#endif
  int lines;    // N, per plane
  int samples;  // D, per line
  int width;    // of the picture, pixels
  int height;

  float r_min_mm;
  float dr_mm;
  float half_reflection_length;  // l/2 in samples
  float reflection_exponent;     // dr/l

  float absorption_per_sample;  // f dr/100 ln 10: times dB/(cm MHz), the loss in ln I per sample
  float coupling_depth_mm;
  float least_alpha_with_normal;  // weaker interfaces take a mean tilt instead of their normal
  float clutter_share;            // of the mean echo from the same depth; 0 for none

  float face_reflection;
  int two_way;  // 1: T = I^2
  float blend;  // b
  float fixed_level;

  float reflection_exponent_px;  // -1/(2 s^2) of the smoothing's Gaussians, s in pixels
  float transmission_exponent_px;
  float noise_level;  // mean of the electronic noise in units of U; 0 for none
  float gain_db;

  float dynamic_range_db;     // beta
  float clutter_kept;         // e^(-dr/kClutterTail_mm), see sim/model/noise.h
  float deflection_kept;      // e^(-dr/kDeflection_mm), see sim/model/refraction.h
  float deflection_per_step;  // dr/(l kDeflection_rad)

  float deflection_loss;  // dr/kDeflection_mm
  float slice_thickness_mm;
  float slice_spread;  // growth of the slice's thickness per mm from its focus
  float elevation_focus_mm;

  int planes;       // whose lines are processed together, stored one after the other: 1 for a picture
  int first_plane;  // index of the first of these in the sweep
  int noise_step;   // shift of the noise from one plane to the next, lines
  float specular_exponent;

  int noise_shift_x;  // with waves: of the picture's noise, pixels
  int noise_shift_y;
  float blend_amplitude;  // b^(1/2)
  float pulse_exponent;   // of the pulse's Gaussian, by samples^2

  int look;               // which of the looks is converted (sim/model/compounding.h)
  float of_frame_before;  // its share in this frame; 0 for a probe at rest
  float edge_enhancement;
  float speckle_reduction;

  float speckle_variance;    // v_0 of sim/model/display_filter.h
  float filter_exponent_px;  // -1/(2 s^2) of its window, s in pixels
  float mirror_amplitude;    // of what gas mirrors
  float face_amplitude;      // of mirror images: the root of the settings' face_reflection

  float ring_down;             // d of sim/model/waves.h where the first sample's part of a line begins; 0 for none
  float ring_down_per_sample;  // its loss, in ln
  int unused_1, unused_2;

  vec4 tgc_db[2];  // time gain at 8 depths from the face to full depth
#ifdef __cplusplus
};
}  // namespace insonate::gl
#else
};
#endif
