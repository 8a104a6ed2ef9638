// The parameters of the volume view's shader. The shader reads them and C++ writes them; both include this file
// (std140).
#ifdef __cplusplus
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
namespace insonate::view {
using glm::mat4;
using glm::vec4;
struct VolumeViewParameters {
#else
layout(std140, binding = 0) uniform VolumeViewParameters {
#endif
  mat4 tissue_from_patient;   // patient mm -> coordinates of the tissue and body textures
  mat4 texture_from_patient;  // patient mm -> coordinates of the CT's texture
  mat4 probe_from_patient;
  vec4 eye;    // patient mm
  vec4 right;  // a ray's direction is into + x right + y down, x and y from -1 to 1 over the picture
  vec4 down;
  vec4 into;     // unit vector
  vec4 picture;  // width, height, mm per pixel at 1 mm from the eye, unused

  vec4 image_geometry;  // of the ultrasound: left and top edge in the probe's plane, mm; mm per pixel; unused
  vec4 probe_shape;     // radius of the face (0: flat), half its angle (rad) or half its width (mm), unused
  vec4 probe_low;       // the box around the probe's housing (view/probe_body.glsl) in the probe's frame, mm
  vec4 probe_high;

  float step_mm;
  float voxel_mm;  // of the tissue texture
  float skin;      // opacity of the skin seen face on
  float cut_face;  // opacity of the cut's face

  int cut;
  int show_plane;
  int show_probe;
  int show_organs;

  // For the CT itself.
  float ct_step_mm;
  int jitter;      // whether samples begin at another place in each pixel
  int skip_empty;  // whether empty cells are leapt over
  int body_only;   // whether the table is left out

  float structure_opacity;  // of the surfaces of structures within the CT
  int first_row;            // of the part that is drawn now; a fragment shader is cut to it
  int end_row;
  int unused;
#ifdef __cplusplus
};
}  // namespace insonate::view
#else
};
#endif
