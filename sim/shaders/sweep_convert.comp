// Backward warp from the lines of a sweep to a volume: a voxel finds the two planes on its sides and its place among
// the lines of each, and takes from each by its distance. An invocation a voxel.

layout(local_size_x = 32, local_size_y = 4) in;

#include "shared/sweep_parameters.h"

layout(binding = 0) uniform sampler3D values;              // x sample, y line, z plane
layout(binding = 1) uniform sampler2D plane_from_voxel;    // a row a plane: the rows of a matrix, voxel -> plane, mm
layout(binding = 0, rg32f) writeonly uniform image3D volume;  // value, 1; 0, 0 outside the sweep

const int kLinear = 0, kCurvilinear = 1, kPhased = 2;  // as ProbeKind

vec3 in_plane(int plane, vec4 voxel) {
  return vec3(dot(texelFetch(plane_from_voxel, ivec2(0, plane), 0), voxel),
              dot(texelFetch(plane_from_voxel, ivec2(1, plane), 0), voxel),
              dot(texelFetch(plane_from_voxel, ivec2(2, plane), 0), voxel));
}

float height_above(int plane, vec4 voxel) { return dot(texelFetch(plane_from_voxel, ivec2(2, plane), 0), voxel); }

// Across the face or the field of view, 0 to 1 inside, and mm along the line from the face.
vec2 across_and_depth(vec2 p) {
  if (probe_kind == kLinear) return vec2(p.x / face_width_mm + 0.5, p.y);
  float below_apex = p.y + apex_behind_mm, from_apex = length(vec2(p.x, below_apex));
  float r = probe_kind == kPhased ? from_apex * p.y / below_apex : from_apex - apex_behind_mm;
  return vec2(atan(p.x, below_apex) / field_of_view + 0.5, probe_kind == kPhased && p.y < 0.0 ? -1.0 : r);
}

// Bilinear in one plane, and 1; (0, 0) outside its fan.
vec2 value_at(int plane, vec2 p) {
  vec2 at = across_and_depth(p);
  if (at.x < 0.0 || at.x > 1.0 || at.y < 0.0 || at.y > depth_mm) return vec2(0.0);
  ivec2 last = ivec2(samples, lines) - 1;
  vec2 position = clamp(vec2(at.y * samples_per_mm, at.x * float(lines)) - 0.5, vec2(0.0), vec2(last));
  ivec2 low = min(ivec2(position), max(last - 1, 0)), high = min(low + 1, last);
  vec2 f = position - vec2(low);
  float near = mix(texelFetch(values, ivec3(low, plane), 0).x, texelFetch(values, ivec3(low.x, high.y, plane), 0).x, f.y);
  float far = mix(texelFetch(values, ivec3(high.x, low.y, plane), 0).x, texelFetch(values, ivec3(high, plane), 0).x, f.y);
  return vec2(mix(near, far, f.x), 1.0);
}

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (at.x >= width || at.y >= height) return;
  vec4 voxel = vec4(at, 1.0);

  // The voxel lies on other sides of the first and the last plane; halving what is between keeps that true.
  int low = 0, high = planes - 1;
  float height_low = height_above(low, voxel), height_high = height_above(high, voxel);
  vec2 found = vec2(0.0);
  if (height_low * height_high <= 0.0) {
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
    vec2 before = value_at(low, in_plane(low, voxel).xy), behind = value_at(high, in_plane(high, voxel).xy);
    float inside = before.y * behind.y;
    found = inside * vec2(mix(before.x, behind.x, share), 1.0);
  }
  imageStore(volume, at, vec4(found, 0.0, 0.0));
}
