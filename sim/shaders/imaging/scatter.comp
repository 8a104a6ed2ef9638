// Places the scatterers of sim/model/waves.h among the lines: n / c, a complex number for each sample.
//
// Scatterers lie in cubic cells that are fixed to the patient. The slice cuts through columns of cells. An invocation
// takes the column through which the slice cuts most steeply, draws the scatterer of each of its cells that can lie in
// the slice, and adds it to the two samples around it on both lines beside it. Neighbouring columns add to the same
// samples, so the sums are atomic and in fixed point: the order does not matter, and equal poses give equal bits.
//
// Atomic sums are most of the work. So a sum holds both shares of what lies between two samples: in its lower half that
// of the sample in front, in its upper half that of the one behind.
//
// Reads the list of columns. Adds to the scatterers' sums, which are 0 before.
// Dispatch: one work group of 32 per entry of the list, in rows; an entry is the first of 32 columns.

layout(local_size_x = 32) in;

#include "shared/simulation_parameters.h"
#include "shared/scatter_parameters.h"

// As LineFan::Face.
const int kParallel = 0, kRound = 1, kFlat = 2;

layout(std430, binding = 0) readonly buffer Columns { ivec2 first_column[]; };
// A row per line: re and im of what lies in front of sample 0, between samples 0 and 1, ..., and behind the last.
layout(std430, binding = 1) buffer Scattered { int scattered[]; };

// As sim/core/hash.h.
uint hash(uint h) {
  h ^= h >> 16;
  h *= 0x85ebca6bu;
  h ^= h >> 13;
  h *= 0xc2b2ae35u;
  return h ^ (h >> 16);
}

// Returns the angle between (0, 1) and `at`, which is `length` long, to 6e-7: twice that at the far end of the diameter,
// by the polynomial for the arc tangent of 0 to 1 that has the least largest error. GLSL leaves the accuracy of its own
// open, and Mesa's takes longer.
float angle_of(vec2 at, float length) {
  float across = abs(at.x), along = max(length + at.y, 1e-6);
  float t = min(across, along) / max(across, along), s = t * t;
  float half_angle = t * (0.99999613 + s * (-0.33317369 + s * (0.19807816 + s * (-0.13233341 + s * (0.079623662 +
                     s * (-0.033604212 + s * 0.0068117911))))));
  if (across > along) half_angle = 1.57079633 - half_angle;
  return at.x < 0.0 ? -2.0 * half_angle : 2.0 * half_angle;
}

// Returns the place among lines (x) and the distance from the face (y), as position_among() of sim/probe/probe.h does.
vec2 place_among(vec2 at) {
#if FACE == 0 && STEERED == 1
  return vec2((at.x - at.y * (steering_sine / steering_cosine) - first_across) * lines_across, at.y / steering_cosine);
#elif FACE == 0
  return vec2((at.x - first_across) * lines_across, at.y);
#else
  float below_apex = at.y + apex_mm, from_apex = sqrt(at.x * at.x + below_apex * below_apex);
  float r = from_apex - apex_mm;
  if (FACE == kFlat)
    r = below_apex > face_of_outer_line * from_apex ? from_apex * at.y / below_apex
                                                    : from_apex - apex_mm / face_of_outer_line;
  float angle = angle_of(vec2(at.x, below_apex), from_apex);
#if STEERED == 1
  float to_tangent = apex_mm * steering_sine;
  r = sqrt(max(from_apex * from_apex - to_tangent * to_tangent, 0.0)) - apex_mm * steering_cosine;
  angle -= angle_of(vec2(r * steering_sine, apex_mm + r * steering_cosine), from_apex);
#endif
  return vec2((angle - first_across) * lines_across, r);
#endif
}

float thickness_at_mm(float r) {
#if ELEVATION_FOCUS == 1
  float spread = slice_spread * (r - elevation_focus_mm);
  return sqrt(slice_thickness_mm * slice_thickness_mm + spread * spread);
#else
  return slice_thickness_mm;
#endif
}

// Adds what lies `behind` of the way between two samples of a row.
void add(int row, int between, float amplitude, float behind, int part) {
  ivec2 shares = ivec2(round(amplitude * quanta * vec2(1.0 - behind, behind)));
  atomicAdd(scattered[2 * (row * (samples + 1) + between) + part], shares.x + (shares.y << 16));
}

void main() {
  int group = int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
  ivec2 column = first_column[group] + ivec2(gl_LocalInvocationID.x, 0);
  mat3 steps_mm = mat3(probe_from_cell[0].xyz, probe_from_cell[1].xyz, probe_from_cell[2].xyz);
  ivec3 bottom = column.x * across.xyz + column.y * up.xyz;
  float z_of_middle = probe_from_corner.z + (steps_mm * (vec3(bottom) + 0.5)).z;
  bottom += int(ceil((-probe_from_corner.w - z_of_middle) / z_per_step)) * down.xyz;

  vec3 corner_mm = probe_from_corner.xyz + steps_mm * (vec3(bottom) + 0.5 / 1024.0);
  vec3 down_mm = steps_mm * vec3(down.xyz);
  mat3 per_place_mm = steps_mm / 1024.0;
  uint key = keys.w + keys.x * uint(bottom.x) + keys.y * uint(bottom.y) + keys.z * uint(bottom.z);
  uint key_step = keys.x * uint(down.x) + keys.y * uint(down.y) + keys.z * uint(down.z);
#if STEERED == 1
  uint phase = phase_steps.w + 1024u * (phase_steps.x * uint(bottom.x) + phase_steps.y * uint(bottom.y) +
                                        phase_steps.z * uint(bottom.z));
  uint phase_step = 1024u * (phase_steps.x * uint(down.x) + phase_steps.y * uint(down.y) +
                             phase_steps.z * uint(down.z));
#endif
  for (int i = 0; i < steps; ++i) {
    uint bits = hash(key + uint(i) * key_step);
    uvec3 places = (uvec3(bits) >> uvec3(0u, 10u, 20u)) & 1023u;
    vec3 at = corner_mm + float(i) * down_mm + per_place_mm * vec3(places);
    vec2 place = place_among(at.xy);
    float share = at.z / (slice_half * thickness_at_mm(place.y)), window = max(1.0 - share * share, 0.0);
    vec2 position = vec2(place.x, (place.y - r_min_mm) / dr_mm + 0.5);  // among lines, and among sums of a row
    if (window == 0.0 || position.y < 0.0 || position.y >= float(samples + 1)) continue;

    uint quarter = bits >> 30;  // the amplitude is this power of i
#if STEERED == 1
    quarter += (phase + uint(i) * phase_step + phase_steps.x * places.x + phase_steps.y * places.y +
                phase_steps.z * places.z) >> 30;
#endif
    float amplitude = (quarter & 2u) == 0u ? window * window : -window * window;
    int part = int(quarter & 1u);
    int line = int(floor(position.x)), between = int(position.y);
    vec2 beside = fract(position);
    if (line >= 0 && line < lines) add(first_row + line, between, amplitude * (1.0 - beside.x), beside.y, part);
    if (line >= -1 && line < lines - 1) add(first_row + line + 1, between, amplitude * beside.x, beside.y, part);
  }
}
