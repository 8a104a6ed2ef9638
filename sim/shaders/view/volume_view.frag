// Volume view: direct volume rendering by ray casting. It composites skin, organs and bone front to back. The
// ultrasound picture, the face of the cut and the probe take their places in depth.
//
// Reads what view/volume_ray.glsl lists. Writes the colour. Draw: full-screen pass, one ray per fragment.
layout(location = 0) out vec4 colour;

#include "view/volume_ray.glsl"
#ifdef CT_MARCH
#include "view/ct_march.glsl"
#else
#include "view/organ_march.glsl"
#endif

void main() {
  vec2 at = 2.0 * gl_FragCoord.xy / picture.xy - 1.0;
  Ray ray = ray_at(at);
  March march = march_of(ray);
  float end = min(ray.end, ray.t_probe);
  bool plane_seen = ray.t_plane < ray.t_probe;
  for (int part = 0; part < 2; ++part) {  // in front of the plane, and behind it
    march_to(march, ray.direction, part == 0 && plane_seen ? min(ray.t_plane, end) : end);
    if (part == 0 && plane_seen) composite_plane(ray);
  }
  composite_probe(ray);
  colour = over_background(at);
}
