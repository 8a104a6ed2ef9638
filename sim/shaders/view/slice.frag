// A slice through the CT, and the outlines of the labels. In the plane of the ultrasound picture it is mixed with that
// picture, which covers the same part of the plane.
//
// Reads the CT, the ultrasound picture (if its share is above 0, or the CT is dimmed outside the fan) and the labels.
// Writes the colour. Draw: full-screen pass, one fragment per pixel of the picture.

#include "view/slice_parameters.h"
#include "view/hounsfield.glsl"

layout(binding = 1) uniform sampler2D ultrasound_image;  // alpha 0 outside the fan
layout(binding = 2) uniform usampler3D labels;

layout(location = 0) out vec4 colour;

vec3 texture_position(vec2 pixel) {
  return (texture_from_pixel * vec4(pixel, 0.0, 1.0)).xyz;
}

uint label_at(vec2 pixel) {
  ivec3 size = textureSize(labels, 0);
  ivec3 voxel = ivec3(floor(texture_position(pixel) * vec3(size)));
  if (any(lessThan(voxel, ivec3(0))) || any(greaterThanEqual(voxel, size))) return 0u;
  return texelFetch(labels, voxel, 0).x;
}

// Returns the colour of the label whose inner edge runs through the pixel; alpha 0 where none does.
vec4 outline_at(vec2 pixel) {
  const vec2 around[4] = vec2[](vec2(-1.5, 0.0), vec2(1.5, 0.0), vec2(0.0, -1.5), vec2(0.0, 1.5));
  uint here = label_at(pixel);
  bool on_edge = false;
  // A loop and not an `if`: a software renderer skips it where no pixel has a label to outline.
  for (int i = 0; i < 4 && here != 0u && outline[here].a > 0.0 && !on_edge; ++i) on_edge = label_at(pixel + around[i]) != here;
  return on_edge ? outline[here] : vec4(0.0);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float ct = clamp((hounsfield(texture_position(vec2(pixel))) - level_hu) / window_hu + 0.5, 0.0, 1.0);
  vec4 echo = textureLod(ultrasound_image, gl_FragCoord.xy / picture_size.xy, 0.0);
  vec3 shown = echo.a > 0.5 ? mix(vec3(ct), echo.rgb * ultrasound_white.rgb, ultrasound) : vec3(ct * outside_fan);
  vec4 edge = outline_at(vec2(pixel));
  colour = vec4(mix(shown, edge.rgb, edge.a * (echo.a > 0.5 ? 0.85 : 0.85 * outside_fan)), 1.0);
}
