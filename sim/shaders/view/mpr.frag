// Reformatted plane of a reconstructed ultrasound volume: its grey levels in any plane.
//
// Reads the volume: grey, and what is known of each voxel. Writes the colour.
// Draw: full-screen pass, one fragment per pixel of the picture.

#include "view/mpr_parameters.h"

layout(binding = 0) uniform sampler3D volume;  // grey; 0 unseen, 1/2 filled, 1 measured

layout(location = 0) out vec4 colour;

void main() {
  vec3 index = (index_from_pixel * vec4(floor(gl_FragCoord.xy), 0.0, 1.0)).xyz;
  ivec3 size = textureSize(volume, 0), base = ivec3(floor(index));
  colour = unseen;
  bool inside = all(greaterThan(index, vec3(-1.0))) && all(lessThan(index, vec3(size)));
  for (bool todo = inside; todo; todo = false) {
    // Trilinear among the known voxels, so that the sweep's border is not dark. The nearest voxel decides whether
    // anything is known here.
    ivec3 nearest = ivec3(floor(index + 0.5));
    if (any(lessThan(nearest, ivec3(0))) || any(greaterThanEqual(nearest, size))) break;
    float here = texelFetch(volume, nearest, 0).y;
    if (here == 0.0) break;
    vec3 share = index - vec3(base);
    float sum = 0.0, weights = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      ivec3 step = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
      vec2 voxel = texelFetch(volume, clamp(base + step, ivec3(0), size - 1), 0).xy;
      vec3 along = mix(1.0 - share, share, vec3(step));
      float weight = voxel.y > 0.0 ? along.x * along.y * along.z : 0.0;
      sum += weight * voxel.x;
      weights += weight;
    }
    colour = vec4(vec3(sum / weights) * (here < 0.75 ? filled_tint.rgb : vec3(1.0)), 1.0);
  }
}
