// The volume view while things move, first pass, in few pixels: skin, organs and bone in front of the ultrasound's plane
// and behind it, without the plane and the probe. volume_finish.frag puts those in, in many pixels.
//
// Reads what view/volume_ray.glsl lists. Writes both layers as colour times opacity and opacity, the back one as it is
// seen through the front one, so that their sum has no seam where no plane is between them; and the opacity of what
// hides the probe. Draw: full-screen pass, one ray per fragment.
layout(location = 0) out vec4 front;
layout(location = 1) out vec4 back;
layout(location = 2) out float before_probe;

#include "view/volume_ray.glsl"
#ifdef CT_MARCH
#include "view/ct_march.glsl"
#else
#include "view/organ_march.glsl"
#endif

// Returns whether the picture covers all that a pixel of the second pass can see of this one's back layer.
bool fan_covers(Ray ray) {
  if (show_plane == 0) return false;
  vec2 image_mm = image_geometry.z * vec2(textureSize(ultrasound_image, 0));
  vec3 patient = eye.xyz + ray.t_plane * ray.direction;
  vec2 uv = ((probe_from_patient * vec4(patient, 1.0)).xy - image_geometry.xy) / image_mm;
  vec2 around = 2.0 * picture.z * ray.t_plane / max(abs(ray.probe_direction.z), 0.25) / image_mm;
  return min(min(fan_at(uv + around), fan_at(uv - around)),
             min(fan_at(uv + around * vec2(1, -1)), fan_at(uv + around * vec2(-1, 1)))) == 1.0;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  Ray ray = ray_at(place_of(pixel));
  March march = march_of(ray, pixel);
  bool plane_first = ray.t_plane < ray.t_probe, hidden = false, covered = false;
  float through = 1.0;  // the front layer
  front = vec4(0.0);
  before_probe = 0.0;
  for (int part = 0; part < 3; ++part) {  // to the plane and to the probe, whichever comes first, and to the end
    float stop = part == 0 ? min(ray.t_plane, ray.t_probe) : part == 1 ? max(ray.t_plane, ray.t_probe) : kNever;
    if (!hidden) march_to(march, ray.direction, min(stop, ray.end));
    if (part == (plane_first ? 0 : 1) && ray.t_plane < kNever) {
      front = sum;
      covered = fan_covers(ray);
      hidden = sum.a >= kOpaque || covered;
      through = 1.0 - sum.a;
      sum = vec4(0.0);
    }
    if (part == (plane_first ? 1 : 0) && ray.t_probe < kNever) before_probe = through * sum.a;
  }
  back = covered ? vec4(0.0, 0.0, 0.0, 1.0) : through * sum;  // opaque, so that no silhouette shows there
  if (ray.t_plane >= kNever) {  // all of it is in front
    front = sum;
    back = vec4(0.0);
  }
}
