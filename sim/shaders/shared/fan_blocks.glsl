// The picture's stages run over the blocks of pixels that the fan touches, a work group each; what lies outside stays as
// it was cleared. An invocation serves four pixels: starting one costs a software renderer as much as a pixel does.
const ivec2 kBlock = ivec2(64, 4);
layout(std430, binding = 7) readonly buffer FanBlocks { ivec2 fan_block[]; };

// Which block is a work group's own. One row of groups need not hold all of them; what fills the last row lies outside the
// picture.
int block() { return int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x); }

// The first of an invocation's four pixels, in a work group of 16 x 4 that goes along rows ...
ivec2 first_of_row() { return fan_block[block()] * kBlock + ivec2(gl_LocalInvocationID.xy) * ivec2(4, 1); }
// ... or in one of 64 x 1 that goes down columns.
ivec2 first_of_column() { return fan_block[block()] * kBlock + ivec2(gl_LocalInvocationID.xy) * ivec2(1, 4); }

// Where a pixel is in what the stages hand on.
int index_of(ivec2 pixel) { return pixel.y * width + pixel.x; }
