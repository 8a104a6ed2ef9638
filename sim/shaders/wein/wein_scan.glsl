// The scan lines of a chunk as the stages behind the traversal read them, and the table of the pixels to convert.

layout(binding = 0) uniform samplerBuffer scan;     // one row per line; interleaved images: wein_parameters.h
layout(binding = 1) uniform isamplerBuffer pixels;  // one row per step, one column per invocation, as PixelTable in C++

const int kNextLine = lines > 1 ? row_samples : 0, kNextSample = samples > 1 ? 1 : 0;

// Returns the entry of this invocation at a step.
ivec4 pixel_at(int step) {
  return texelFetch(pixels, step * int(gl_NumWorkGroups.x * gl_WorkGroupSize.x) + int(gl_GlobalInvocationID.x));
}
int steps() { return textureSize(pixels) / int(gl_NumWorkGroups.x * gl_WorkGroupSize.x); }

// Samples the scan at a pixel, for the `image_group`th group of images that share a texel. The pixel gives the sample
// in front, and the fractions to the next sample and to the next line.
vec4 scanned_at(ivec4 pixel, int image_group) {
  int low = image_group * (lines * row_samples) + max(pixel.x, 0);
  vec2 f = intBitsToFloat(pixel.yz);
  vec4 here = mix(texelFetch(scan, low), texelFetch(scan, low + kNextSample), f.x);
  low += kNextLine;
  return mix(here, mix(texelFetch(scan, low), texelFetch(scan, low + kNextSample), f.x), f.y);
}
