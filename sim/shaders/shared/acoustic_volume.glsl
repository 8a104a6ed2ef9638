// The volume that the simulation samples, and the tissue table for its Hounsfield units.

#include "shared/model_constants.h"

// (HU, echogenicity in hundredths of a dB) / 32767, with a voxel of air all around
layout(binding = 0) uniform sampler3D acoustic_volume;

// One texel per whole HU from -1024 on: impedance (MRayl), absorption (dB/(cm MHz)), and the increase of both to the
// next HU. Values between are linear, which is exact because the tissue table's knots lie at whole HU.
layout(binding = 7) uniform samplerBuffer tissue_at_hu;

const float kFirst_hu = -1024.0;
const vec2 kGel = vec2(0.0, -6000.0);         // water's density, without echo
const vec2 kOutside = vec2(-1000.0, -6000.0);  // outside the volume and around the body

// Returns the share of gel in what lies within the gel layer, 0 to 1 (sim/tissue/coupling.h).
float gel_share(float hu) { return clamp((kCouplingTissue_hu - hu) / (kCouplingTissue_hu - kCouplingAir_hu), 0.0, 1.0); }

vec2 impedance_and_absorption(float hu) {
  float position = clamp(hu - kFirst_hu, 0.0, 4095.0);
  int below = int(position);
  vec4 known = texelFetch(tissue_at_hu, below);
  return known.xy + (position - float(below)) * known.zw;
}
