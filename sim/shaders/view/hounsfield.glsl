// The CT as the views sample it.

layout(binding = 0) uniform sampler3D acoustic_volume;  // (HU, ...) / 32767, with a voxel of air on every side

// Returns HU at a position in [0, 1] over the CT's own voxels.
float hounsfield(vec3 at) {
  vec3 texels = vec3(textureSize(acoustic_volume, 0));
  return textureLod(acoustic_volume, (at * (texels - 2.0) + 1.0) / texels, 0.0).x * 32767.0;
}
