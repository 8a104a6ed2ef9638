// The parameters of model W's stages: read by the shaders and written by C++, which both include this file.
// std140: every group of four scalars below fills one 16-byte row.
#ifdef __cplusplus
#pragma once
#include <glm/vec4.hpp>
namespace insonate::gl {
using glm::vec4;
struct WeinParameters {
#else
layout(std140, binding = 0) uniform WeinParameters {
#endif
  int lines;    // of an image
  int samples;  // a line
  int width;    // of an image, pixels
  int height;

  int images;   // of this chunk
  int first;    // the chunk's first image among all
  int columns;  // of images in the grid
  int shadows;  // 1: echogenicity is scaled by I

  float first_free_sample;  // those before lie in contact, where nothing reflects
  float dr_by_length;       // dr/l
  float compression;        // a
  float one_over_compressed_one;  // 1/ln(1 + a)

  float dark_hu;
  float one_over_hu_range;  // from dark to bright
  float reflection_share;
  float last_log_intensity;  // ln I below which a line is left

  int patches;  // 1: LC2's parts are patches, each compared by itself
  int unused0, unused1, unused2;

  vec4 sides_by_dr;  // of the volume, in sample distances
#ifdef __cplusplus
};
}  // namespace insonate::gl
#else
};
#endif
