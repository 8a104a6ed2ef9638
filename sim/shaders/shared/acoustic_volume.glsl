// The volume as sound meets it, and what its Hounsfield units mean.

// (HU, echogenicity in hundredths of a dB) / 32767, with a voxel of air all around
layout(binding = 0) uniform sampler3D acoustic_volume;

// Impedance (MRayl) and absorption (dB/(cm MHz)) at each whole HU from -1024 on, and what they rise by to the next; linear
// between, which is exact because the tissue table's knots sit at whole HU.
layout(binding = 7) uniform samplerBuffer tissue_at_hu;

const float kFirstHu = -1024.0;
const vec2 kGel = vec2(0.0, -6000.0);         // water's density, and no echo
const vec2 kOutside = vec2(-1000.0, -6000.0);  // beyond the volume, and all around the body

// Of what lies within the gel layer, the share that is gel: as in sim/reference/reference.h.
const float kCouplingTissueHu = -150.0, kCouplingAirHu = -301.0;
float gel_share(float hu) { return clamp((kCouplingTissueHu - hu) / (kCouplingTissueHu - kCouplingAirHu), 0.0, 1.0); }

vec2 impedance_and_absorption(float hu) {
  float position = clamp(hu - kFirstHu, 0.0, 4095.0);
  int below = int(position);
  vec4 known = texelFetch(tissue_at_hu, below);
  return known.xy + (position - float(below)) * known.zw;
}
