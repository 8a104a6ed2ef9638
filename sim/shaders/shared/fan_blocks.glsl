// The picture's stages run over the blocks of pixels that the fan touches, one work group per block. Pixels outside
// these stay cleared. An invocation serves four pixels: starting one costs a software renderer as much as one pixel
// does.
const ivec2 kBlock = ivec2(64, 4);
layout(std430, binding = 7) readonly buffer FanBlocks { ivec2 fan_block[]; };

// Returns the index of the work group's block. One row of work groups need not hold all blocks. The blocks that fill up
// the last row lie outside the picture.
int block() { return int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x); }

// Return the first of an invocation's four pixels, in a work group of 16 x 4 that runs along rows ...
ivec2 first_of_row() { return fan_block[block()] * kBlock + ivec2(gl_LocalInvocationID.xy) * ivec2(4, 1); }
// ... or in one of 64 x 1 that runs down columns.
ivec2 first_of_column() { return fan_block[block()] * kBlock + ivec2(gl_LocalInvocationID.xy) * ivec2(1, 4); }

// Returns the index of a pixel in the buffers of the stages.
int index_of(ivec2 pixel) { return pixel.y * width + pixel.x; }
