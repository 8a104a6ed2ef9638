// The picture's stages run over the blocks of pixels that the fan touches, a work group each; what lies outside stays as
// it was cleared.
const ivec2 kBlock = ivec2(32, 8);
layout(std430, binding = 7) readonly buffer FanBlocks { ivec2 fan_block[]; };

// The first pixel of this work group's block.
ivec2 block_start() { return fan_block[gl_WorkGroupID.x] * kBlock; }
