// The parameters of the shader of reformatted planes. The shader reads them and C++ writes them; both include this file
// (std140).
#ifdef __cplusplus
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
namespace insonate::view {
using glm::mat4;
using glm::vec4;
struct MprParameters {
#else
layout(std140, binding = 0) uniform MprParameters {
#endif
  mat4 index_from_pixel;  // (x, y, 0, 1) of a pixel's centre -> continuous voxel index

  vec4 unseen;       // colour where nothing is known
  vec4 filled_tint;  // factors on the grey of filled voxels
#ifdef __cplusplus
};
}  // namespace insonate::view
#else
};
#endif
