// The volume as sound meets it, and what its Hounsfield units mean.

layout(binding = 0) uniform sampler3D acoustic_volume;  // (HU, echogenicity in hundredths of a dB) / 32767

// Impedance (MRayl) and absorption (dB/(cm MHz)) at each whole HU from -1024 on; linear between, which is exact because
// the tissue table's knots sit at whole HU.
layout(std430, binding = 1) readonly buffer TissueLookup { vec2 tissue_at_hu[4096]; };

const float kFirstHu = -1024.0;
const float kCouplingAirHu = -300.0;         // below this, what lies within the gel layer is gel
const vec2 kGel = vec2(0.0, -6000.0);         // water's density, and no echo
const vec2 kOutside = vec2(-1000.0, -6000.0);  // beyond the volume, and all around the body

vec2 impedance_and_absorption(float hu) {
  float position = clamp(hu - kFirstHu, 0.0, 4095.0);
  int below = min(int(position), 4094);
  return mix(tissue_at_hu[below], tissue_at_hu[below + 1], position - float(below));
}
