// Trilinear fetches from a volume without other work: neighbouring invocations step side by side, one voxel per step.

layout(local_size_x = GROUP) in;

layout(binding = 0) uniform sampler3D texels;
layout(std430, binding = 0) writeonly buffer Sums { float sums[]; };  // prevents the compiler from removing fetches

void main() {
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint i = group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (i >= sums.length()) return;
  uvec3 size = uvec3(textureSize(texels, 0));
  uint column = i / size.x, columns = max(size.y / FETCHES, 1u);
  vec3 first = vec3(i % size.x, column % columns * FETCHES, column / columns % size.z) + 0.3;
  vec3 at = first / vec3(size), step = vec3(0.0, 1.0 / float(size.y), 0.0);
  vec4 sum = vec4(0.0);
  for (int k = 0; k < FETCHES; ++k) sum += textureLod(texels, at + float(k) * step, 0.0);
  sums[i] = sum.x + sum.y + sum.z + sum.w;
}
