// Ray casting for the volume view: what lies along a ray, and how it looks. To be included before one of the files that
// march along the ray: organ_march.glsl or ct_march.glsl. It reads the CT, the ultrasound picture, and the tissue and
// body textures. The C++ side defines FEW_PIXELS for pictures of fewer pixels than the screen's, and WITHOUT_PROBE where
// the rays do not meet the probe.

#include "view/volume_view_parameters.h"
#include "view/hounsfield.glsl"
#include "view/probe_body.glsl"

layout(binding = 1) uniform sampler2D ultrasound_image;  // alpha 0 outside the fan
layout(binding = 2) uniform sampler3D tissue;            // colour times coverage, coverage
layout(binding = 3) uniform sampler3D body;              // opacity of 1 mm times coverage, share of the patient's body
layout(binding = 10) uniform sampler3D smooth_ct;        // HU / 32767, on the voxels of the tissue texture

#ifdef CT_MARCH
const float kOpaque = 0.996;  // the rest is below one of 255 levels
#else
const float kOpaque = 0.98;
#endif
const float kNever = 1e9;
const vec3 kSkinColour = vec3(0.95, 0.78, 0.68);
const vec3 kFanEdge = vec3(0.36, 0.72, 0.88);
const float kCutWindow_hu = 400.0, kCutLevel_hu = 40.0;

// Shares of the body between which the cut's face begins.
#ifdef FEW_PIXELS
const vec2 kCutEdge = vec2(0.7, 1.0);  // skin, brighter than fat, is thinner than a pixel and would be a line of dots
#else
const vec2 kCutEdge = vec2(0.4, 0.6);
#endif

vec4 sum = vec4(0.0);  // colour times opacity, opacity: what lies between the eye and the ray's present point

void composite(vec3 shade, float opacity) {
  sum += (1.0 - sum.a) * opacity * vec4(shade, 1.0);
}

vec3 background(vec2 at) {
  return mix(vec3(0.085, 0.095, 0.115), vec3(0.045, 0.050, 0.062), smoothstep(0.2, 1.5, length(at)));
}

// Returns the factor for a surface's colour and the highlight. The light is a soft lamp at the viewer's upper left
// shoulder, and a little light from the room.
vec2 lighting(vec3 normal, vec3 view) {
  vec3 lamp = normalize(-into.xyz - 0.45 * normalize(right.xyz) - 0.6 * normalize(down.xyz));
  float diffuse = max(dot(normal, lamp), 0.0);
  float from_above = 0.5 - 0.5 * dot(normal, normalize(down.xyz));
  float highlight = pow(max(dot(normal, normalize(lamp - view)), 0.0), 28.0);
  return vec2(0.22 + 0.12 * from_above + 0.72 * diffuse, highlight);
}

// Returns the normal that faces the viewer. Where there is no gradient, as on a cut, it is the direction to the viewer.
vec3 facing(vec3 gradient, vec3 view) {
  float size = length(gradient);
  if (size < 1e-4) return -view;
  vec3 normal = gradient / size;
  return dot(normal, view) > 0.0 ? -normal : normal;
}

// In voxels of smooth_ct, a whole one: then the gradient is as smooth as the linear interpolation between voxels. With
// 1.5, lines along the voxels' layers show on smooth skin.
const float kGradientReach = 1.0;

// Returns the gradient of the smoothed CT, whose slices do not show, HU per mm.
// @param at  in coordinates of smooth_ct
vec3 smooth_gradient(vec3 at) {
  vec3 reach = kGradientReach / vec3(textureSize(smooth_ct, 0));
  // Differences over the corners of a tetrahedron, which take 4 fetches in place of 6.
  const vec3 kA = vec3(1, -1, -1), kB = vec3(-1, -1, 1), kC = vec3(-1, 1, -1), kD = vec3(1, 1, 1);
  vec3 change = (kA * textureLod(smooth_ct, at + kA * reach, 0.0).x + kB * textureLod(smooth_ct, at + kB * reach, 0.0).x +
                 kC * textureLod(smooth_ct, at + kC * reach, 0.0).x + kD * textureLod(smooth_ct, at + kD * reach, 0.0).x) /
                (4.0 * reach);
  return transpose(mat3(tissue_from_patient)) * (change * 32767.0);
}

float fan_at(vec2 uv) {
  return all(equal(uv, clamp(uv, 0.0, 1.0))) ? textureLod(ultrasound_image, uv, 0.0).a : 0.0;
}

// Composites the picture's plane at a point: ultrasound inside the fan, the fan's edge, and the CT on the cut around
// it. Loops stand where one would write `if`: a software renderer runs both sides of an `if` for all pixels, and takes
// less time, though some, for a loop that none of its pixels enters.
void composite_plane(vec3 patient, float t, float slant) {
  vec2 image_mm = image_geometry.z * vec2(textureSize(ultrasound_image, 0));
  vec2 uv = ((probe_from_patient * vec4(patient, 1.0)).xy - image_geometry.xy) / image_mm;
  // About one pixel of the screen, corrected for the plane's slant.
  vec2 reach = picture.z * t / max(slant, 0.25) / image_mm;
  bool near_image = show_plane == 1 && all(greaterThan(uv, -reach)) && all(lessThan(uv, 1.0 + reach));
  for (bool todo = near_image; todo; todo = false) {
    vec3 echo = textureLod(ultrasound_image, uv, 0.0).rgb;
#ifdef FEW_PIXELS
    float fan = fan_at(uv);
#else
    // The share of the fan around the point.
    float fan = 0.25 * (fan_at(uv + reach * vec2(0.9, 0.4)) + fan_at(uv + reach * vec2(-0.4, 0.9)) +
                        fan_at(uv + reach * vec2(-0.9, -0.4)) + fan_at(uv + reach * vec2(0.4, -0.9)));
    echo = mix(kFanEdge, echo, smoothstep(0.75, 1.0, fan));
#endif
    composite(echo, smoothstep(0.0, 0.5, fan));
  }
  vec3 at = (tissue_from_patient * vec4(patient, 1.0)).xyz;
  bool in_box = all(greaterThanEqual(at, vec3(0.0))) && all(lessThanEqual(at, vec3(1.0)));
  float inside = 0.0;
  for (bool todo = cut == 1 && in_box && sum.a < kOpaque; todo; todo = false)
    inside = smoothstep(kCutEdge.x, kCutEdge.y, textureLod(body, at, 0.0).y);
  for (bool todo = inside > 0.0; todo; todo = false) {
    float hu = hounsfield((texture_from_patient * vec4(patient, 1.0)).xyz);
    float grey = clamp((hu - kCutLevel_hu) / kCutWindow_hu + 0.5, 0.0, 1.0);
    vec4 organ = textureLod(tissue, at, 0.0);
    vec3 shade = vec3(0.9 * grey);
    if (show_organs == 1) shade = mix(shade, organ.rgb * (0.4 + 0.9 * grey), 0.55 * organ.a);
    composite(shade, inside * cut_face);
  }
}

// A ray from the eye, and where it meets the ultrasound's plane, the probe and the patient, mm; kNever if it does not.
struct Ray {
  vec3 direction, probe_eye, probe_direction;  // the latter two in the probe's frame
  float t_plane;  // of the plane as something to be seen or cut along
  float t_probe;
  float begin, end;  // of what is to be marched through
  vec3 box_origin, box_direction;
};

// Returns where a pixel's middle lies in the picture: -1 to 1, from the first column and row.
vec2 place_of(ivec2 pixel) {
  return 2.0 * (vec2(pixel) + 0.5) / picture.xy - 1.0;
}

// @param at  in the picture, as place_of() returns
Ray ray_at(vec2 at) {
  Ray ray;
  ray.direction = normalize(into.xyz + at.x * right.xyz + at.y * down.xyz);
  ray.probe_eye = (probe_from_patient * vec4(eye.xyz, 1.0)).xyz;
  ray.probe_direction = mat3(probe_from_patient) * ray.direction;
  ray.t_plane = -ray.probe_eye.z / ray.probe_direction.z;
  bool meets_plane = ray.t_plane > 0.0 && ray.t_plane < kNever;  // false for a ray within the plane
  if (!meets_plane) ray.t_plane = kNever;
#ifdef WITHOUT_PROBE
  ray.t_probe = kNever;
#else
  ray.t_probe = show_probe == 1 ? meet_probe(ray.probe_eye, ray.probe_direction) : -1.0;
  if (ray.t_probe < 0.0) ray.t_probe = kNever;
#endif

  ray.box_origin = (tissue_from_patient * vec4(eye.xyz, 1.0)).xyz;
  ray.box_direction = mat3(tissue_from_patient) * ray.direction;
  vec3 safe = mix(ray.box_direction, vec3(1e-9), lessThan(abs(ray.box_direction), vec3(1e-9)));
  vec3 a = -ray.box_origin / safe, b = (1.0 - ray.box_origin) / safe;
  vec3 low = min(a, b), high = max(a, b);
  ray.begin = max(max(low.x, low.y), max(low.z, 0.0));
  ray.end = min(min(high.x, high.y), high.z);
  if (cut == 1) ray.begin = max(ray.begin, ray.t_plane);  // a ray that never meets it lies wholly in front of it
  if (show_plane == 0 && cut == 0) ray.t_plane = kNever;
  return ray;
}

// Composites the plane if the ray meets it and it is not hidden.
void composite_plane(Ray ray) {
  for (bool todo = ray.t_plane < kNever && sum.a < kOpaque; todo; todo = false)
    composite_plane(eye.xyz + ray.t_plane * ray.direction, ray.t_plane, abs(ray.probe_direction.z));
}

// Composites the probe if the ray meets it and it is not hidden.
void composite_probe(Ray ray) {
  for (bool todo = ray.t_probe < kNever && sum.a < kOpaque; todo; todo = false) {
    vec3 p = ray.probe_eye + ray.t_probe * ray.probe_direction;
    vec3 normal = transpose(mat3(probe_from_patient)) * probe_normal(p);
    vec2 light = lighting(normal, ray.direction);
    composite(probe_colour(p) * light.x + 0.25 * light.y, 1.0);
  }
}

vec4 over_background(vec2 at) {
  return vec4(sum.rgb + (1.0 - min(sum.a / kOpaque, 1.0)) * background(at), 1.0);
}
