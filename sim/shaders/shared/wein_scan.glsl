// A chunk's scan lines as the stages behind the traversal read them, and the tables of pixels for which they do.

layout(binding = 0) uniform samplerBuffer scan;     // a row a line; in a texel, images side by side: wein_parameters.h
layout(binding = 1) uniform isamplerBuffer pixels;  // by step, a column an invocation, as PixelTable in C++

const int kNextLine = lines > 1 ? row_samples : 0, kNextSample = samples > 1 ? 1 : 0;

// Of this invocation: the texel of a step.
ivec4 pixel_at(int step) {
  return texelFetch(pixels, step * int(gl_NumWorkGroups.x * gl_WorkGroupSize.x) + int(gl_GlobalInvocationID.x));
}
int steps() { return textureSize(pixels) / int(gl_NumWorkGroups.x * gl_WorkGroupSize.x); }

// What was scanned where a pixel lies, of the images that share a texel: behind which sample, and how far to the next
// sample and line. They are the `image_group`th to do so.
vec4 scanned_at(ivec4 pixel, int image_group) {
  int low = image_group * (lines * row_samples) + max(pixel.x, 0);
  vec2 f = intBitsToFloat(pixel.yz);
  vec4 here = mix(texelFetch(scan, low), texelFetch(scan, low + kNextSample), f.x);
  low += kNextLine;
  return mix(here, mix(texelFetch(scan, low), texelFetch(scan, low + kNextSample), f.x), f.y);
}
