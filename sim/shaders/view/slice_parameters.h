// The parameters of the slices' shader. The shader reads them and C++ writes them; both include this file (std140).
#ifdef __cplusplus
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
namespace insonate::view {
using glm::mat4;
using glm::vec4;
struct SliceParameters {
#else
layout(std140, binding = 0) uniform SliceParameters {
#endif
  mat4 texture_from_pixel;  // (x, y, 0, 1) of a pixel's centre -> coordinates of the patient's textures

  vec4 picture_size;        // pixels across and down; 0, 0
  vec4 ultrasound_white;    // the colour of the ultrasound's white; 0

  float window_hu;
  float level_hu;
  float ultrasound;   // share of the ultrasound inside the fan, 0 to 1
  float outside_fan;  // brightness of the CT outside the fan

  vec4 outline[256];  // per label: colour of its edge, alpha 0 for none
#ifdef __cplusplus
};
}  // namespace insonate::view
#else
};
#endif
