// The whole ray of a pixel of the volume view: direct volume rendering that composites skin, organs and bone, or the CT
// itself, front to back. The ultrasound picture, the face of the cut and the probe take their places in depth.
//
// Reads what view/volume_ray.glsl lists.
#include "view/volume_ray.glsl"
#ifdef CT_MARCH
#include "view/ct_march.glsl"
#else
#include "view/organ_march.glsl"
#endif

// @param pixel  row 0 is the top
vec4 colour_of(ivec2 pixel) {
  vec2 at = place_of(pixel);
  Ray ray = ray_at(at);
  March march = march_of(ray, pixel);
  float end = min(ray.end, ray.t_probe);
  bool plane_seen = ray.t_plane < ray.t_probe;
  for (int part = 0; part < 2; ++part) {  // in front of the plane, and behind it
    march_to(march, ray.direction, part == 0 && plane_seen ? min(ray.t_plane, end) : end);
    if (part == 0 && plane_seen) composite_plane(ray);
  }
  composite_probe(ray);
  return over_background(at);
}
