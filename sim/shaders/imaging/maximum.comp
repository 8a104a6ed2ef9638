// Maximum: the brightest level of the frame, from those of its blocks.
//
// Reads what fuse.comp writes per block. Raises `maximum`, which is 0 before.
// Dispatch: one work group of 64, in which each invocation takes every 64th block.

layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer Brightest { uint brightest[]; };  // per block, see fuse.comp
layout(std430, binding = 1) buffer Maximum { uint maximum; };

void main() {
  uint most = 0u;
  for (int block = int(gl_LocalInvocationID.x); block < brightest.length(); block += 64)
    most = max(most, brightest[block]);
  atomicMax(maximum, most);
}
