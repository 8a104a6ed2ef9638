// The march through the CT itself for the volume view: direct volume rendering with a transfer function. Emission and
// absorption, front to back (Kutter, Shams, Navab 2009, equations 8 and 9). To be included behind volume_ray.glsl.
//
// Samples lie at first + k step along a ray, k whole: each pixel has its own `first`, which turns rings into fine noise.
// Leaps end on such places too, so that a picture does not depend on what is leapt over. The C++ side defines
// CT_CLASSIFICATION, one of the two below, CT_SHADED, STRUCTURES (whether surfaces of structures are drawn), and
// VOXELS_PER_CELL, the side of a cell in voxels.

#define POST_CLASSIFICATION 0  // the function at each sample
#define PRE_INTEGRATED 1       // the mean of the function between one sample and the next (sim/view/body/transfer_function.h)

// Per whole HU from kFirstTransfer_hu on, two texels: colour times extinction and extinction, 1/mm, and their integrals.
layout(binding = 8) uniform samplerBuffer transfer;
layout(binding = 9) uniform usampler3D cell_distance;  // cells to the nearest one where something can be visible
#if STRUCTURES
layout(binding = 11) uniform sampler3D structures;  // colour times coverage, coverage; on the voxels of the tissue texture
#endif

const float kFirstTransfer_hu = -1024.0, kLastTransferEntry = 4095.0;

// Where two values are so close, the rounding of the integrals would show; the function changes little between them.
const float kShortSpan_hu = 1.0;

// A surface is lit where the CT changes by more than its noise does, HU per mm.
const float kUnlit_hu_mm = 4.0, kLit_hu_mm = 20.0;
const vec2 kLightWithin = vec2(0.8, 0.0);
const float kHighlight = 0.18;

// Less than this share of the body in the surroundings (smoothed over some 4 mm) is not the patient but the table.
const float kOutsideBody = 0.02, kWithinBody = 0.2;

// Returns the function's value (which = 0) or integral (1) at a Hounsfield unit.
vec4 transferred(float hu, int which) {
  float entry = clamp(hu - kFirstTransfer_hu, 0.0, kLastTransferEntry);
  int below = int(min(entry, kLastTransferEntry - 1.0));
  return mix(texelFetch(transfer, 2 * below + which), texelFetch(transfer, 2 * below + 2 + which), entry - float(below));
}

struct March {
  vec3 origin, direction;  // in coordinates of acoustic_volume; direction per mm
  float t;                 // distance from the eye up to which all is composited, mm
  float first, end;        // where samples begin, and where the CT ends, mm
  float hu;                // at t
  vec4 integral;           // at hu
  bool known;              // whether hu and integral are those at t
  float covered;           // by structures, at t; cells that were leapt over have none
};

// Returns a number from 0 to 1 that differs irregularly from pixel to pixel.
float dither(uvec2 pixel) {
  uint h = pixel.x * 0x9E3779B1u ^ pixel.y * 0x85EBCA77u;
  h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
  h = (h ^ (h >> 13)) * 0x297A2D39u;
  return float((h ^ (h >> 16)) >> 8) / 16777216.0;
}

March march_of(Ray ray, ivec2 pixel) {
  March march;
  vec3 origin = (texture_from_patient * vec4(eye.xyz, 1.0)).xyz, direction = mat3(texture_from_patient) * ray.direction;
  vec3 safe = mix(direction, vec3(1e-9), lessThan(abs(direction), vec3(1e-9)));
  vec3 a = -origin / safe, b = (1.0 - origin) / safe;
  vec3 low = min(a, b), high = max(a, b);
  march.t = max(max(max(low.x, low.y), low.z), ray.begin);
  march.end = min(min(high.x, high.y), high.z);
  march.first = march.t + (jitter == 1 ? dither(uvec2(pixel)) : 0.0) * ct_step_mm;
  march.known = false;
  march.covered = 0.0;
  vec3 texels = vec3(textureSize(acoustic_volume, 0));  // with a margin of 1
  march.origin = (origin * (texels - 2.0) + 1.0) / texels;
  march.direction = direction * (texels - 2.0) / texels;
  return march;
}

float hounsfield_at(March march, float t) {
  return textureLod(acoustic_volume, march.origin + t * march.direction, 0.0).x * 32767.0;
}

// Moves on to the last sample's place before something can be visible, at most to `stop`.
void leap(inout March march, float stop) {
  ivec3 last_cell = textureSize(cell_distance, 0) - 1;
  vec3 texels = vec3(textureSize(acoustic_volume, 0));
  vec3 origin = (march.origin * texels - 1.0) / float(VOXELS_PER_CELL);  // in cells
  vec3 direction = march.direction * texels / float(VOXELS_PER_CELL);
  vec3 safe = mix(direction, vec3(1e-9), lessThan(abs(direction), vec3(1e-9)));
  vec3 per_cell = 1.0 / safe;
  bvec3 forward = greaterThan(safe, vec3(0.0));
  for (int i = 0; i < 256 && march.t < stop; ++i) {
    ivec3 cell = clamp(ivec3(origin + march.t * direction), ivec3(0), last_cell);
    int empty = int(texelFetch(cell_distance, cell, 0).x);
    if (empty == 0) break;
    vec3 exits = (vec3(cell + mix(ivec3(1 - empty), ivec3(empty), forward)) - origin) * per_cell;
    float steps = floor((min(min(exits.x, exits.y), exits.z) - march.first) / ct_step_mm - 1e-3);
    float t = min(march.first + steps * ct_step_mm, stop);
    if (t <= march.t) break;
    march.t = t;
    march.known = false;
    march.covered = 0.0;
  }
}

// Returns how the tissue around a point is lit: the factor for its colour, and the highlight. The gradient is that of
// the smoothed CT, whose slices do not show.
// @param at  in coordinates of smooth_ct
vec2 light_at(vec3 at, vec3 view) {
  vec3 gradient = smooth_gradient(at);
  return mix(kLightWithin, lighting(facing(gradient, view), view),
             smoothstep(kUnlit_hu_mm, kLit_hu_mm, length(gradient)));
}

// Returns the share of what is at a point that belongs to the patient.
// @param at  in coordinates of the tissue and body textures
float of_body(vec3 at) {
  return body_only == 0 ? 1.0 : smoothstep(kOutsideBody, kWithinBody, textureLod(body, at, 0.0).y);
}

#if STRUCTURES
// Composites the surface of a structure if the ray passes one between march.t and t. It is where the coverage is one
// half, so that its depth does not depend on the steps.
void composite_structures(inout March march, vec3 direction, float t) {
  vec3 box_direction = mat3(tissue_from_patient) * direction;
  vec3 box_origin = (tissue_from_patient * vec4(eye.xyz, 1.0)).xyz;
  float covered = textureLod(structures, box_origin + t * box_direction, 0.0).a;
  for (bool todo = (covered > 0.5) != (march.covered > 0.5); todo; todo = false) {
    vec3 at = box_origin + mix(march.t, t, (0.5 - march.covered) / (covered - march.covered)) * box_direction;
    vec3 reach = 1.0 / vec3(textureSize(structures, 0));
    vec3 change;
    for (int axis = 0; axis < 3; ++axis) {
      vec3 aside = vec3(axis == 0, axis == 1, axis == 2) * reach;
      change[axis] = textureLod(structures, at + aside, 0.0).a - textureLod(structures, at - aside, 0.0).a;
    }
    vec3 gradient = transpose(mat3(tissue_from_patient)) * (change / reach);
    vec2 light = lighting(facing(gradient, direction), direction);
    vec4 surface = textureLod(structures, at, 0.0);
    composite(surface.rgb / max(surface.a, 0.01) * light.x + kHighlight * light.y, structure_opacity);
  }
  march.covered = covered;
}
#endif

// Advances to `stop`, and composites the tissue on the way. Loops stand for `if`, as in volume_ray.glsl.
void march_to(inout March march, vec3 direction, float stop) {
  stop = min(stop, march.end);
  for (int i = 0; i < 8192 && march.t < stop && sum.a < kOpaque; ++i) {
    if (skip_empty == 1) leap(march, stop);
    for (bool todo = !march.known; todo; todo = false) {
      march.hu = hounsfield_at(march, march.t);
      march.integral = transferred(march.hu, 1);
      march.known = true;
    }
    float next = march.first + (floor((march.t - march.first) / ct_step_mm + 1e-3) + 1.0) * ct_step_mm;
    float t = min(next, stop), segment_mm = t - march.t;
    float hu = hounsfield_at(march, t);
#if STRUCTURES
    composite_structures(march, direction, t);
#endif
#if CT_CLASSIFICATION == PRE_INTEGRATED
    vec4 integral = transferred(hu, 1), tissue_seen = (integral - march.integral) / (hu - march.hu);
    for (bool todo = abs(hu - march.hu) < kShortSpan_hu; todo; todo = false)
      tissue_seen = transferred(0.5 * (hu + march.hu), 0);
    march.integral = integral;
#else
    vec4 tissue_seen = transferred(hu, 0);
#endif
    for (bool todo = tissue_seen.a > 0.0 && segment_mm > 0.0; todo; todo = false) {
      vec3 at = (tissue_from_patient * vec4(eye.xyz + (t - 0.5 * segment_mm) * direction, 1.0)).xyz;
      float opacity = 1.0 - exp(-tissue_seen.a * segment_mm * of_body(at));
      vec2 light = vec2(1.0, 0.0);
#if CT_SHADED
      light = light_at(at, direction);
#endif
      composite(tissue_seen.rgb / tissue_seen.a * light.x + kHighlight * light.y, opacity);
    }
    march.hu = hu;
    march.t = t;
  }
}
