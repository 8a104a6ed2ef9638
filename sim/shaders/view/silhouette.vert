// The pixels around the patient's silhouette in the volume view while things move. The few pixels of its layers would
// show as steps there, so that volume_view.frag casts a whole ray for each of these.
//
// Reads the layers of volume_layers.frag, and gl_VertexID: a vertex is a pixel of the layers. Writes its place, or one
// outside the picture if it and its neighbours are alike. Draw: points (Points, sim/gl/objects.h), as many pixels wide as
// one of the layers' is.
#include "view/volume_view_parameters.h"

layout(binding = 3) uniform sampler3D body;  // opacity of 1 mm times coverage, share of the patient's body
layout(binding = 5) uniform sampler2D front_layer;
layout(binding = 6) uniform sampler2D back_layer;

uniform ivec3 vertices;  // the first one's column and row, and their number in a row

const float kSeen = 0.3;  // opacity that shows beside a pixel without any

// Returns whether the face of the cut is there, which hides most of what lies behind it.
bool on_cut(vec2 at) {
  vec3 direction = into.xyz + at.x * right.xyz + at.y * down.xyz;
  vec3 from = (probe_from_patient * vec4(eye.xyz, 1.0)).xyz, along = mat3(probe_from_patient) * direction;
  float t = -from.z / along.z;
  vec3 place = (tissue_from_patient * vec4(eye.xyz + t * direction, 1.0)).xyz;
  bool in_box = all(greaterThanEqual(place, vec3(0.0))) && all(lessThanEqual(place, vec3(1.0)));
  return t > 0.0 && in_box && textureLod(body, place, 0.0).y > 0.6;
}

void main() {
  vec2 size = vec2(textureSize(back_layer, 0));
  vec2 pixel = vec2(vertices.xy + ivec2(gl_VertexID % vertices.z, gl_VertexID / vertices.z));
  float least = 1.0, most = 0.0;
  bool hidden = cut == 1;
  for (int corner = 0; corner < 4; ++corner) {
    vec2 uv = (pixel + vec2(corner & 1, corner >> 1)) / size;
    vec4 opacity = textureGather(back_layer, uv, 3);
    if (cut == 0) opacity += textureGather(front_layer, uv, 3);  // else it is cut away
    least = min(least, min(min(opacity.x, opacity.y), min(opacity.z, opacity.w)));
    most = max(most, max(max(opacity.x, opacity.y), max(opacity.z, opacity.w)));
    hidden = hidden && on_cut(2.0 * uv - 1.0);
  }
  bool is_edge = least == 0.0 && most > kSeen && !hidden;
  gl_Position = is_edge ? vec4(2.0 * (pixel + 0.5) / size - 1.0, 0.0, 1.0) : vec4(2.0, 2.0, 0.0, 1.0);
}
