// The volume view while things move, second pass, in many pixels: the ultrasound's plane, the face of the cut and the
// probe, sharp, between the layers that volume_layers.frag has drawn in few pixels.
//
// Reads the layers and what view/volume_ray.glsl lists. Writes the colour. Draw: full-screen passes, each cut to where
// what it draws can be seen.
layout(binding = 5) uniform sampler2D front_layer;
layout(binding = 6) uniform sampler2D back_layer;
layout(binding = 7) uniform sampler2D before_probe_layer;

layout(location = 0) out vec4 colour;

#include "view/volume_ray.glsl"

// The C++ side defines BACKGROUND where pixels show nothing else, WITHOUT_PLANE where they show neither the plane nor the
// probe, and WITHOUT_PROBE where they do not show the probe: in a software renderer, code that no pixel needs costs
// nothing only if it is not there.
#ifdef BACKGROUND
void main() {
  colour = over_background(2.0 * gl_FragCoord.xy / picture.xy - 1.0);
}
#elif defined(WITHOUT_PLANE)
void main() {
  vec2 uv = gl_FragCoord.xy / picture.xy;
  sum = textureLod(back_layer, uv, 0.0);
  if (cut == 0) sum += textureLod(front_layer, uv, 0.0);  // else it is cut away
  colour = over_background(2.0 * uv - 1.0);
}
#else
void main() {
  vec2 uv = gl_FragCoord.xy / picture.xy, at = 2.0 * uv - 1.0;
  Ray ray = ray_at(at);
  bool probe = ray.t_probe < kNever, plane_first = ray.t_plane < ray.t_probe;
  vec4 front = vec4(0.0), back = vec4(0.0), hiding = vec4(0.0);
  for (bool todo = cut == 0; todo; todo = false) front = textureLod(front_layer, uv, 0.0);  // else it is cut away
  for (bool todo = probe; todo; todo = false) {
    // The colour of what hides the probe is not known apart from that of its whole layer, which is alike.
    vec4 nearer = plane_first ? textureLod(back_layer, uv, 0.0) : front;
    float hides = textureLod(before_probe_layer, uv, 0.0).x;
    if (nearer.a > 0.0) hiding = nearer * min(hides / nearer.a, 1.0);
  }
  float through = 1.0;  // the plane
  if (!probe || plane_first) {
    sum = front;
    composite_plane(ray);
    if (front.a < 1.0) through = (1.0 - sum.a) / (1.0 - front.a);
  }
  for (bool todo = !probe && sum.a < kOpaque; todo; todo = false) back = textureLod(back_layer, uv, 0.0);
  sum += through * (probe ? hiding : back);
  composite_probe(ray);
  colour = over_background(at);
}
#endif
