// Scan conversion of a sweep: a backward warp from its lines to a volume. A voxel finds the two planes on its sides and
// its position among the lines of each. It mixes the bilinear values of both by its distances to them.
//
// Reads the values on the lines and the planes' matrices. Writes the value and the depth of each voxel of a slab.
// Dispatch: width x height x slices invocations, one per voxel, in work groups of 32 x 4 x 1.

layout(local_size_x = 32, local_size_y = 4) in;

#include "shared/sweep_parameters.h"

layout(binding = 0) uniform samplerBuffer values;            // one row per line, plane by plane
layout(binding = 1) uniform samplerBuffer plane_from_voxel;  // per plane: three rows of a matrix, voxel -> plane, mm
layout(std430, binding = 0) writeonly buffer Slices { vec2 slices[]; };  // value, share of the depth along the line;
                                                                         // 0, -1 outside the sweep
const vec2 kOutside = vec2(0.0, -1.0);

const int kLinear = 0, kCurvilinear = 1, kPhased = 2;  // as ProbeKind

vec2 in_plane(int plane, vec4 voxel) {
  return vec2(dot(texelFetch(plane_from_voxel, 3 * plane), voxel),
              dot(texelFetch(plane_from_voxel, 3 * plane + 1), voxel));
}

float height_above(int plane, vec4 voxel) { return dot(texelFetch(plane_from_voxel, 3 * plane + 2), voxel); }

// Returns x: the position across the face or the field of view, 0 to 1 inside; y: mm from the face along the line.
vec2 across_and_depth(vec2 p) {
  if (probe_kind == kLinear) return vec2(p.x / face_width_mm + 0.5, p.y);
  float below_apex = p.y + apex_behind_mm, from_apex = length(vec2(p.x, below_apex));
  float r = probe_kind == kPhased ? from_apex * p.y / below_apex : from_apex - apex_behind_mm;
  return vec2(atan(p.x, below_apex) / field_of_view + 0.5, probe_kind == kPhased && p.y < 0.0 ? -1.0 : r);
}

// Returns the bilinear value in one plane and the point's share of the depth; kOutside outside the plane's fan.
vec2 value_at(int plane, vec2 p) {
  vec2 at = across_and_depth(p);
  if (at.x < 0.0 || at.x > 1.0 || at.y < 0.0 || at.y > depth_mm) return kOutside;
  ivec2 last = ivec2(samples, lines) - 1;
  vec2 position = clamp(vec2(at.y / depth_mm * float(samples), at.x * float(lines)) - 0.5, vec2(0.0), vec2(last));
  ivec2 low = min(ivec2(position), max(last - 1, 0)), high = min(low + 1, last);
  vec2 f = position - vec2(low);
  ivec2 row = (plane * lines + ivec2(low.y, high.y)) * samples;
  float near = mix(texelFetch(values, row.x + low.x).x, texelFetch(values, row.y + low.x).x, f.y);
  float far = mix(texelFetch(values, row.x + high.x).x, texelFetch(values, row.y + high.x).x, f.y);
  return vec2(mix(near, far, f.x), at.y / depth_mm);
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (at.x >= width || at.y >= height) return;
  vec4 voxel = vec4(at.xy, at.z + first_slice, 1.0);

  // Bisection: the voxel lies on different sides of planes `low` and `high`, and each step keeps that true.
  int low = 0, high = planes - 1;
  float height_low = height_above(low, voxel), height_high = height_above(high, voxel);
  vec2 found = kOutside;
  // A voxel on a plane counts as before it: the part that ends with the plane has already converted the voxel.
  bool between = height_low * height_high <= 0.0 && (height_low != 0.0 || is_first_part == 1);
  if (between) {
    while (high - low > 1) {
      int middle = (low + high) / 2;
      float height_middle = height_above(middle, voxel);
      bool in_lower_half = height_low * height_middle <= 0.0;
      high = in_lower_half ? middle : high;
      height_high = in_lower_half ? height_middle : height_high;
      low = in_lower_half ? low : middle;
      height_low = in_lower_half ? height_low : height_middle;
    }
    float apart = abs(height_low) + abs(height_high), share = apart > 0.0 ? abs(height_low) / apart : 0.0;
    vec2 before = value_at(low, in_plane(low, voxel)), behind = value_at(high, in_plane(high, voxel));
    if (before.y >= 0.0 && behind.y >= 0.0) found = mix(before, behind, share);
  }
  if (between || is_first_part == 1) slices[(at.z * height + at.y) * width + at.x] = found;
}
