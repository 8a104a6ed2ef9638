// Filter error: samples a texture with the device's own trilinear filter, for comparison with exact values.
//
// Reads the texture and the places. Writes one value per place.
// Dispatch: one invocation per place, in work groups of 64.

layout(local_size_x = 64) in;

layout(binding = 0) uniform sampler3D texels;
layout(std430, binding = 0) readonly buffer Places { vec4 places[]; };  // in [0, 1]
layout(std430, binding = 1) writeonly buffer Values { float values[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < places.length()) values[i] = textureLod(texels, places[i].xyz, 0.0).x;
}
