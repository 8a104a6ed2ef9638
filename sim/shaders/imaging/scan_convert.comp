// Scan conversion: a backward warp from the lines to the picture, bilinear, and the part of the fusion (6) that needs
// no smoothing:
//
//     U = X + S (R + b T)
//
// R and T stand here for what smooth.comp smooths. X holds all the rest, which includes S R and b S T where R and T are
// not smoothed. The position of each pixel among the lines is computed once per probe and depth, so this stage does not
// depend on the probe.
//
// With WAVES, f is interpolated and U = |f + d + noise|^2 + V (sim/model/waves.h): X = U, and nothing is smoothed.
//
// Reads the echoes, the pixels' positions, the noise and the mean echo. Writes X and S, and R and T where smoothed.
// Dispatch: one work group of 64 x 1 per block of the fan (shared/fan_blocks.glsl). An invocation serves four pixels of
// a column.

layout(local_size_x = 64, local_size_y = 1) in;

#include "shared/simulation_parameters.h"
#include "shared/least_echo.glsl"
#include "shared/fan_blocks.glsl"

layout(binding = 0) uniform samplerBuffer echoes;           // one row per line: R, T, S, V; with WAVES f, I^2, V
layout(binding = 1) uniform samplerBuffer line_and_sample;  // per pixel; line below -1 outside the fan
layout(binding = 2) uniform samplerBuffer noise;            // per pixel, with mean 1; with WAVES complex
layout(binding = 3) uniform samplerBuffer mean_echo;        // per sample: mean echo over the lines, with its tail, H, H/J
#if LOOKS == 1
layout(std430, binding = 0) writeonly buffer Picture { vec2 picture[]; };  // X, S
#else
layout(std430, binding = 0) writeonly buffer Picture { float picture[]; };  // U^(1/2) of one look after the other; -1
                                                                           // outside a look's lines
#endif
layout(std430, binding = 1) writeonly buffer Sharp { SMOOTHED sharp[]; };  // R, T where smoothed; -1 outside the fan

// Returns the noise's mean at a place along the lines: the electronic noise and, with CLUTTER, what side
// lobes and, with WAVES, the body wall bring.
float noise_at(float sample_position, float arriving) {
#if CLUTTER == 1
  float position = clamp(sample_position, 0.0, float(samples - 1));
  int low = int(position), high = min(low + 1, samples - 1);
  vec4 mean = mix(texelFetch(mean_echo, low), texelFetch(mean_echo, high), position - float(low));
  return noise_level + clutter_share * (WAVES == 1 ? 1.0 : blend) * mean.x + min(mean.y, mean.z * arriving);
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
  // On the last sample, `low` is that sample. Interpolating from a much louder one before would cancel all its digits.
  ivec2 low = ivec2(position), high = min(low + 1, last);
  vec2 f = position - vec2(low);
  vec4 value = mix(mix(echo_at(low.x, low.y), echo_at(high.x, low.y), f.x),
                   mix(echo_at(low.x, high.y), echo_at(high.x, high.y), f.x), f.y);

#if WAVES == 1
#if NOISE == 1
  ivec2 shifted = (pixel + ivec2(noise_shift_x, noise_shift_y)) % ivec2(width, height);
  value.xy += sqrt(noise_at(place.y, value.z)) * texelFetch(noise, index_of(shifted)).xy;
#endif
  if (ring_down > 0.0) value.x += ring_down * exp(-ring_down_per_sample * (place.y + 0.5));
  float echo = dot(value.xy, value.xy) + value.w;
  echo = inside && echo > kMinEcho ? echo : 0.0;
#if LOOKS == 1
  picture[index_of(pixel)] = vec2(echo, 0.0);
#else
  picture[look * width * height + index_of(pixel)] = inside ? sqrt(echo) : -1.0;
#endif
#else
  float rest = value.w;
#if REFLECTION_SMOOTHED == 0
  rest += value.z * value.x;
#endif
#if TRANSMISSION_SMOOTHED == 0
  rest += value.z * blend * value.y;
#endif
#if NOISE == 1
  rest += noise_at(place.y, 0.0) * texelFetch(noise, index_of(pixel)).x;
#endif
  picture[index_of(pixel)] = vec2(rest, value.z);
#if REFLECTION_SMOOTHED == 1 || TRANSMISSION_SMOOTHED == 1
  sharp[index_of(pixel)] = inside ? SMOOTHED(value) : SMOOTHED(-1.0);
#endif
#endif
}

void main() {
  ivec2 first = first_of_column();
  for (int i = 0; i < 4; ++i)
    if (first.x < width && first.y + i < height) convert(first + ivec2(0, i));
}
