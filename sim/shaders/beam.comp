// Beam width (4): reflections and scatterers' echoes across the lines of the active aperture. Scatterers add up as
// complex amplitudes before their envelope is taken, which is what makes speckle.

layout(local_size_x = 16, local_size_y = 4) in;

#include "shared/simulation_parameters.h"

layout(binding = 0) uniform sampler2D scan;
layout(std430, binding = 2) readonly buffer BeamWeights { float beam_weight[]; };       // 2 beam_half + 1, sum 1
layout(std430, binding = 3) readonly buffer SpeckleScale { float envelope_scale[]; };  // a sample: mean envelope -> 1
layout(binding = 0, rgba32f) writeonly uniform image2D echoes;  // x line, y sample: R, T, S, 0

void main() {
  ivec2 here = ivec2(gl_GlobalInvocationID.xy);
  if (here.x >= lines || here.y >= samples) return;

  float reflection = 0.0;
  vec2 echo = vec2(0.0);
  float total = 0.0;
  for (int j = max(-beam_half, -here.x); j <= min(beam_half, lines - 1 - here.x); ++j) {
    float weight = beam_weight[j + beam_half];
    vec4 neighbour = texelFetch(scan, here + ivec2(j, 0), 0);
    reflection += weight * neighbour.y;
    echo += weight * neighbour.zw;
    total += weight;
  }
  float intensity = texelFetch(scan, here, 0).x;
  float transmission = two_way == 1 ? intensity * intensity : intensity;
  float envelope = length(echo) / total * (speckle == 1 ? envelope_scale[here.y] : 1.0);
  imageStore(echoes, here, vec4(reflection / total, transmission, envelope, 0.0));
}
