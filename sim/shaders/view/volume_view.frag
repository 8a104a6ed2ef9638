// The whole volume view, one ray per fragment: for software renderers.
//
// Reads what view/volume_ray.glsl lists. Writes the colour. Draw: full-screen pass.
layout(location = 0) out vec4 colour;

#include "view/whole_ray.glsl"

void main() {
  colour = colour_of(ivec2(gl_FragCoord.xy));
}
