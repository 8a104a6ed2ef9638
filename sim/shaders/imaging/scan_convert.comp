// Backward warp from the lines to the picture, bilinear, and what of the fusion (6) needs no smoothing. Where each pixel
// lies among the lines is worked out once per probe and depth, so this stage knows no probe.
//
// U = X + S (R + b T), with R and T as they are smoothed: X is all the rest, and holds what of R and T is not smoothed.

layout(local_size_x = 64, local_size_y = 1) in;

#include "shared/simulation_parameters.h"
#include "shared/fan_blocks.glsl"

layout(binding = 0) uniform samplerBuffer echoes;           // a row a line: R, T, S, V
layout(binding = 1) uniform samplerBuffer line_and_sample;  // per pixel; line below -1 outside the fan
layout(binding = 2) uniform samplerBuffer noise;            // per pixel, of mean 1
layout(binding = 3) uniform samplerBuffer mean_echo;        // a sample: mean of T S over the lines, with its tail
layout(std430, binding = 0) writeonly buffer Picture { vec2 picture[]; };  // X, S
layout(std430, binding = 1) writeonly buffer Sharp { SMOOTHED sharp[]; };  // R, T as far as smoothed; -1 outside the fan

// The noise's mean at a place along the lines: of the electronics, and with CLUTTER what the side lobes bring.
float noise_at(float sample_position) {
#if CLUTTER == 1
  float position = clamp(sample_position, 0.0, float(samples - 1));
  int low = int(position), high = min(low + 1, samples - 1);
  float mean = mix(texelFetch(mean_echo, low).x, texelFetch(mean_echo, high).x, position - float(low));
  return noise_level + clutter_share * blend * mean;
#else
  return noise_level;
#endif
}

vec4 echo_at(int sample_index, int line) {
  return texelFetch(echoes, line * samples + sample_index);
}

void convert(ivec2 pixel) {
  vec2 place = texelFetch(line_and_sample, index_of(pixel)).xy;
  bool inside = place.x > -1.0;
  ivec2 last = ivec2(samples, lines) - 1;
  vec2 position = clamp(place.yx, vec2(0.0), vec2(last));
  // On the last sample that is low itself: a difference to a louder one would leave nothing of its own digits.
  ivec2 low = ivec2(position), high = min(low + 1, last);
  vec2 f = position - vec2(low);
  vec4 value = mix(mix(echo_at(low.x, low.y), echo_at(high.x, low.y), f.x),
                   mix(echo_at(low.x, high.y), echo_at(high.x, high.y), f.x), f.y);

  float rest = value.w;
#if REFLECTION_SMOOTHED == 0
  rest += value.z * value.x;
#endif
#if TRANSMISSION_SMOOTHED == 0
  rest += value.z * blend * value.y;
#endif
#if NOISE == 1
  rest += noise_at(place.y) * texelFetch(noise, index_of(pixel)).x;
#endif
  picture[index_of(pixel)] = vec2(rest, value.z);
#if REFLECTION_SMOOTHED == 1 || TRANSMISSION_SMOOTHED == 1
  sharp[index_of(pixel)] = inside ? SMOOTHED(value) : SMOOTHED(-1.0);
#endif
}

void main() {
  ivec2 first = first_of_column();
  for (int i = 0; i < 4; ++i)
    if (first.x < width && first.y + i < height) convert(first + ivec2(0, i));
}
