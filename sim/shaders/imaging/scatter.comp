// Places the scatterers of sim/model/waves.h among the lines: n_p / c, a complex number for each sample of each slice
// plane.
//
// Scatterers lie in cubic cells that are fixed to the patient. The slice cuts through columns of cells. An invocation
// takes the column through which the slice cuts most steeply, draws the scatterer of each of its cells that can lie in
// the slice, and adds it to the four samples around it. Neighbouring columns add to the same samples, so the sums are
// atomic and in fixed point: the order does not matter, and equal poses give equal bits.
//
// Reads the list of columns. Adds to the scatterers' sums, which are 0 before.
// Dispatch: one work group of 32 per entry of the list, in rows; an entry is the first of 32 columns.

layout(local_size_x = 32) in;

#include "shared/simulation_parameters.h"
#include "shared/scatter_parameters.h"

// As LineFan::Face.
const int kParallel = 0, kRound = 1, kFlat = 2;

layout(std430, binding = 0) readonly buffer Columns { ivec2 first_column[]; };
layout(std430, binding = 1) buffer Scattered { int scattered[]; };  // a row per line: re in the lower half, im above

// As sim/core/hash.h.
uint hash(uint h) {
  h ^= h >> 16;
  h *= 0x85ebca6bu;
  h ^= h >> 13;
  h *= 0xc2b2ae35u;
  return h ^ (h >> 16);
}
uint hash(uint a, uint b) { return hash(hash(a) + 0x9e3779b9u + b); }

// Returns the place among lines (x) and the distance from the face (y).
vec2 place_among(vec2 at) {
#if FACE == 0
  return vec2((at.x - first_across) * lines_across, at.y);
#else
  float below_apex = at.y + apex_mm, from_apex = sqrt(at.x * at.x + below_apex * below_apex);
  float r = FACE == kFlat ? from_apex * at.y / below_apex : from_apex - apex_mm;
  return vec2((atan(at.x, below_apex) - first_across) * lines_across, r);
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

// Adds an amplitude to a sample's real part (part 0) or its imaginary part (16).
void add(int at, bool lies, float amplitude, int part) {
  if (lies) atomicAdd(scattered[at], int(round(amplitude * quanta)) << part);
}

void main() {
  int group = int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
  ivec2 column = first_column[group] + ivec2(gl_LocalInvocationID.x, 0);
  mat3 steps_mm = mat3(probe_from_cell[0].xyz, probe_from_cell[1].xyz, probe_from_cell[2].xyz);
  ivec3 bottom = column.x * across.xyz + column.y * up.xyz;
  float z_of_middle = probe_from_corner.z + (steps_mm * (vec3(bottom) + 0.5)).z;
  bottom += int(ceil((-probe_from_corner.w - z_of_middle) / z_per_step)) * down.xyz;

  for (int i = 0; i < steps; ++i) {
    ivec3 cell = bottom + i * down.xyz;
    uvec3 absolute = uvec3(cell + corner.xyz);
    uint bits = hash(hash(hash(seed, absolute.x), absolute.y), absolute.z);
    uvec3 bytes = (uvec3(bits) >> uvec3(0u, 8u, 16u)) & 255u;
    vec3 at = probe_from_corner.xyz + steps_mm * (vec3(cell) + (vec3(bytes) + 0.5) / 256.0);
    vec2 place = place_among(at.xy);
    float thickness = at.z / thickness_at_mm(place.y), share = thickness / slice_half;
    float window = max(1.0 - share * share, 0.0);
    float amplitude = (float(bits >> 25) - 63.5) * 0.02706412 * window * window;  // (12/16383)^(1/2)
    int part = int(bits >> 20) & 16;  // the fourth byte's lowest bit

    int slice_plane = clamp(int(floor(thickness * slice_planes_per_thickness + 0.5 * float(SLICE_PLANES))), 0,
                            SLICE_PLANES - 1);
    vec2 position = vec2(place.x, (place.y - r_min_mm) / dr_mm - 0.5), low = floor(position), f = position - low;
    int line = int(low.x), k = int(low.y), at_low = (first_row + slice_plane * lines + line) * samples + k;
    bool drawn = window > 0.0;
    bvec2 line_lies = bvec2(drawn && line >= 0 && line < lines, drawn && line >= -1 && line < lines - 1);
    bvec2 sample_lies = bvec2(k >= 0 && k < samples, k >= -1 && k < samples - 1);
    add(at_low, line_lies.x && sample_lies.x, amplitude * (1.0 - f.x) * (1.0 - f.y), part);
    add(at_low + 1, line_lies.x && sample_lies.y, amplitude * (1.0 - f.x) * f.y, part);
    add(at_low + samples, line_lies.y && sample_lies.x, amplitude * f.x * (1.0 - f.y), part);
    add(at_low + samples + 1, line_lies.y && sample_lies.y, amplitude * f.x * f.y, part);
  }
}
