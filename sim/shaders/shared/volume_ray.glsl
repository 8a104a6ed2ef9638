// Ray casting for the volume view: what lies along a ray, and how it looks. To be included by a fragment shader that has
// declared its output. It reads the CT, the ultrasound picture, the tissue and body textures and the distances between
// blocks. The C++ side defines VOXELS_PER_BLOCK, the side of a block in voxels.

#include "shared/volume_view_parameters.h"
#include "shared/hounsfield.glsl"
#include "shared/probe_body.glsl"

layout(binding = 1) uniform sampler2D ultrasound_image;  // alpha 0 outside the fan
layout(binding = 2) uniform sampler3D tissue;            // colour times coverage, coverage
layout(binding = 3) uniform sampler3D body;              // opacity of 1 mm times coverage, share of the patient's body
layout(binding = 4) uniform usampler3D block_distance;   // blocks to the nearest one where something changes

const float kOpaque = 0.98;
const float kNever = 1e9;
const vec3 kSkinColour = vec3(0.95, 0.78, 0.68);
const vec3 kFanEdge = vec3(0.36, 0.72, 0.88);
const float kCutWindow_hu = 400.0, kCutLevel_hu = 40.0;

vec4 sum = vec4(0.0);  // colour times opacity, opacity: what lies between the eye and the ray's present point

void composite(vec3 shade, float opacity) {
  sum += (1.0 - sum.a) * opacity * vec4(shade, 1.0);
}

// Composites a layer: colour times opacity, opacity.
void composite_layer(vec4 layer) {
  sum += (1.0 - sum.a) * layer;
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

// Returns gradients by central differences over one voxel, per patient mm: [0] of the opacity, [1] of the body's share.
mat2x3 gradients(vec3 at, vec3 step_uv) {
  vec2 dx = textureLod(body, at + vec3(step_uv.x, 0, 0), 0.0).xy - textureLod(body, at - vec3(step_uv.x, 0, 0), 0.0).xy;
  vec2 dy = textureLod(body, at + vec3(0, step_uv.y, 0), 0.0).xy - textureLod(body, at - vec3(0, step_uv.y, 0), 0.0).xy;
  vec2 dz = textureLod(body, at + vec3(0, 0, step_uv.z), 0.0).xy - textureLod(body, at - vec3(0, 0, step_uv.z), 0.0).xy;
  mat3 to_patient = transpose(mat3(tissue_from_patient));
  return mat2x3(to_patient * (vec3(dx.x, dy.x, dz.x) / step_uv), to_patient * (vec3(dx.y, dy.y, dz.y) / step_uv));
}

// Returns the normal that faces the viewer. Where there is no gradient, as on a cut, it is the direction to the viewer.
vec3 facing(vec3 gradient, vec3 view) {
  float size = length(gradient);
  if (size < 1e-4) return -view;
  vec3 normal = gradient / size;
  return dot(normal, view) > 0.0 ? -normal : normal;
}

float fan_at(vec2 uv) {
  return all(equal(uv, clamp(uv, 0.0, 1.0))) ? textureLod(ultrasound_image, uv, 0.0).a : 0.0;
}

// Composites the picture's plane at a point: ultrasound inside the fan, the fan's edge, and the CT on the cut around
// it. Loops stand where one would write `if`: a software renderer runs both sides of an `if` for all pixels, but skips a
// loop that none of its pixels enters.
void composite_plane(vec3 patient, float t, float slant) {
  vec2 image_mm = image_geometry.z * vec2(textureSize(ultrasound_image, 0));
  vec2 uv = ((probe_from_patient * vec4(patient, 1.0)).xy - image_geometry.xy) / image_mm;
  // About one pixel of the screen, corrected for the plane's slant.
  vec2 reach = picture.z * t / max(slant, 0.25) / image_mm;
  bool near_image = show_plane == 1 && all(greaterThan(uv, -reach)) && all(lessThan(uv, 1.0 + reach));
  for (bool todo = near_image; todo; todo = false) {
    // The share of the fan around the point.
    float fan = 0.25 * (fan_at(uv + reach * vec2(0.9, 0.4)) + fan_at(uv + reach * vec2(-0.4, 0.9)) +
                        fan_at(uv + reach * vec2(-0.9, -0.4)) + fan_at(uv + reach * vec2(0.4, -0.9)));
    vec3 echo = textureLod(ultrasound_image, uv, 0.0).rgb;
    composite(mix(kFanEdge, echo, smoothstep(0.75, 1.0, fan)), smoothstep(0.0, 0.5, fan));
  }
  vec3 at = (tissue_from_patient * vec4(patient, 1.0)).xyz;
  bool in_box = all(greaterThanEqual(at, vec3(0.0))) && all(lessThanEqual(at, vec3(1.0)));
  float inside = 0.0;
  for (bool todo = cut == 1 && in_box && sum.a < kOpaque; todo; todo = false)
    inside = smoothstep(0.4, 0.6, textureLod(body, at, 0.0).y);
  for (bool todo = inside > 0.0; todo; todo = false) {
    float hu = hounsfield((texture_from_patient * vec4(patient, 1.0)).xyz);
    float grey = clamp((hu - kCutLevel_hu) / kCutWindow_hu + 0.5, 0.0, 1.0);
    vec4 organ = textureLod(tissue, at, 0.0);
    vec3 shade = vec3(0.9 * grey);
    if (show_organs == 1) shade = mix(shade, organ.rgb * (0.4 + 0.9 * grey), 0.55 * organ.a);
    composite(shade, inside * cut_face);
  }
}

// The state of a ray on its way through the patient.
struct March {
  vec3 box_origin, box_direction;  // in coordinates of the tissue texture; direction per mm
  float t;                         // distance from the eye, mm
  float before, t_before;          // share of the body at the previous sample, -1 for none yet, and its t
  float here;                      // share of the body at t
  bool in_organ;
  vec2 light;  // of the organ's surface where the ray entered the organ
};

const int kNothing = 0, kSkin = 1, kOrgan = 2;

// Advances until the ray meets the skin or an organ, or `stop`, and returns which. The shading of what it meets is kept
// out of this loop: a software renderer runs all code of a loop's body for all samples, whatever its branches select.
int march_to_event(inout March march, float stop) {
  vec3 blocks_per_uv = vec3(textureSize(body, 0)) / float(VOXELS_PER_BLOCK);
  vec3 safe = mix(march.box_direction, vec3(1e-9), lessThan(abs(march.box_direction), vec3(1e-9)));
  vec3 block_origin = march.box_origin * blocks_per_uv, per_block = 1.0 / (safe * blocks_per_uv);
  bvec3 forward = greaterThan(safe, vec3(0.0));
  ivec3 last_block = textureSize(block_distance, 0) - 1;

  // The bounds of both loops are guards far above what is needed.
  for (int i = 0; i < 4096; ++i) {
    vec3 uv;
    for (int leap = 0; leap < 1024; ++leap) {  // skips blocks in which nothing changes
      uv = march.box_origin + march.t * march.box_direction;
      ivec3 block = clamp(ivec3(uv * blocks_per_uv), ivec3(0), last_block);
      int empty = int(texelFetch(block_distance, block, 0).x);
      if (empty == 0) break;
      vec3 exits = (vec3(block + mix(ivec3(1 - empty), ivec3(empty), forward)) - block_origin) * per_block;
      march.t = max(min(min(exits.x, exits.y), exits.z), march.t) + 0.02;
      if (march.t >= stop) break;
    }
    if (march.t >= stop) return kNothing;

    vec2 solid_and_body = textureLod(body, uv, 0.0).xy;
    march.here = solid_and_body.y;
    if (march.before >= 0.0 && (march.before - 0.5) * (march.here - 0.5) < 0.0 && skin > 0.0) return kSkin;
    march.before = march.here;
    march.t_before = march.t;

    vec4 organ = textureLod(tissue, uv, 0.0);
    float coverage = show_organs == 1 ? smoothstep(0.35, 0.65, organ.a) : 0.0;
    if (coverage > 0.0 && !march.in_organ) return kOrgan;
    if (coverage > 0.0) {
      float opacity = coverage * (1.0 - pow(1.0 - min(solid_and_body.x / organ.a, 0.999), step_mm));
      composite(organ.rgb / organ.a * march.light.x + 0.10 * march.light.y, opacity);
      if (sum.a >= kOpaque) return kNothing;
    }
    march.in_organ = coverage > 0.0;
    // Smoothing has spread every edge over two voxels, so a step of a whole voxel is safe where there is nothing.
    march.t += organ.a == 0.0 && (march.here == 0.0 || march.here == 1.0) ? max(step_mm, voxel_mm) : step_mm;
  }
  return kNothing;
}

// Advances to `stop`, and composites the skin and the organs on the way.
void march_to(inout March march, vec3 direction, float stop) {
  vec3 voxel_uv = 1.0 / vec3(textureSize(body, 0));
  for (int i = 0; i < 256 && march.t < stop && sum.a < kOpaque; ++i) {
    int event = march_to_event(march, stop);
    float t_event = event == kSkin ? mix(march.t_before, march.t, (0.5 - march.before) / (march.here - march.before))
                                   : march.t;
    mat2x3 gradient = gradients(march.box_origin + t_event * march.box_direction, voxel_uv);
    vec3 normal = facing(gradient[event == kSkin ? 1 : 0], direction);
    if (event == kSkin) {
      // The skin looks like glass: more opaque where it turns away from the viewer, less when seen from within.
      float rim = 1.0 - abs(dot(normal, direction));
      float side = march.here > march.before ? 1.0 : 0.5;
      vec2 light = lighting(normal, direction);
      composite(kSkinColour * light.x + 0.15 * light.y, mix(skin, 0.7, rim * rim) * side);
      march.before = march.here;
    } else if (event == kOrgan) {
      march.light = lighting(normal, direction);
      march.in_organ = true;
    }
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

// @param at  in the picture, -1 to 1 from the bottom left
Ray ray_at(vec2 at) {
  Ray ray;
  ray.direction = normalize(into.xyz + at.x * right.xyz + at.y * down.xyz);
  ray.probe_eye = (probe_from_patient * vec4(eye.xyz, 1.0)).xyz;
  ray.probe_direction = mat3(probe_from_patient) * ray.direction;
  ray.t_plane = -ray.probe_eye.z / ray.probe_direction.z;
  bool meets_plane = ray.t_plane > 0.0 && ray.t_plane < kNever;  // false for a ray within the plane
  if (!meets_plane) ray.t_plane = kNever;
  ray.t_probe = show_probe == 1 ? meet_probe(ray.probe_eye, ray.probe_direction) : -1.0;
  if (ray.t_probe < 0.0) ray.t_probe = kNever;

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

March march_of(Ray ray) {
  return March(ray.box_origin, ray.box_direction, ray.begin, -1.0, ray.begin, 0.0, false, vec2(0.0));
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
