// The parameters of model W's stages. The shaders read them and C++ writes them; both include this file.
#ifdef __cplusplus
#pragma once
namespace insonate::gl {
struct WeinParameters {
#else
layout(std140, binding = 0) uniform WeinParameters {
#endif
  int images;   // in this chunk
  int first;    // index of the chunk's first image among all
  int columns;  // of images in the grid
  int ultrasounds;       // images that the simulated ones are compared with, one after the other; 1 or more
  int first_ultrasound;  // of them, among all that are set
  int unused_1, unused_2, unused_3;
#ifdef __cplusplus
};
}  // namespace insonate::gl
#else
};
// What no call changes is compiled in: a software renderer gathers a uniform anew per invocation and use.
const int lines = LINES;              // per image
const int samples = SAMPLES;          // per line
const int row_samples = ROW_SAMPLES;  // room for samples in a line of the scan: an even number
// Images whose samples share a texel of the scan, so that one fetch brings all of them: 4 greys, or both terms of 2
// images. Neighbouring images share where a call asks for many. 1 where images lie one behind the other.
const int interleaved_greys = INTERLEAVED;
const int interleaved_terms = max(INTERLEAVED / 2, 1);
const int tile_words = TILE_WORDS;    // of four pixels, in a row of an image's tile in the grid
const int tile_height = TILE_HEIGHT;  // pixels
const int shadows = SHADOWS;          // 1: echogenicity is scaled by I
const int patches = PATCHES;          // 1: LC2's parts are patches, and each is compared by itself

const float first_free_sample = FIRST_FREE_SAMPLE;  // samples before it lie in contact, where nothing reflects
const float dr_by_length = DR_BY_LENGTH;            // dr/l
const float compression = COMPRESSION;              // a
const float one_over_compressed_one = ONE_OVER_COMPRESSED_ONE;  // 1/ln(1 + a)
const float dark_hu = DARK_HU;
const float one_over_hu_range = ONE_OVER_HU_RANGE;  // from dark_hu to bright_hu
const float reflection_share = REFLECTION_SHARE;
const float last_log_intensity = LAST_LOG_INTENSITY;  // ln I below which the traversal of a line ends
const vec3 sides_by_dr = SIDES_BY_DR;                 // the volume's sides, in sample distances
#endif
