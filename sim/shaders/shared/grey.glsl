// From echo to grey: time gain, gain, log compression (7) and the grey map.

// Time gain compensation and gain, dB: linear between eight depths.
float time_gain_db(float sample_position) {
  float depth = clamp((sample_position + 0.5) / float(samples), 0.0, 1.0) * 7.0;
  int below = min(int(depth), 6);
  float low = tgc_db[below >> 2][below & 3];
  float high = tgc_db[(below + 1) >> 2][(below + 1) & 3];
  return gain_db + mix(low, high, depth - float(below));
}

const float kSilent = -1e30;       // level of a pixel without any echo
const float kOutsideFan = 1e30;    // and of one outside the fan

// In decibels, because gains may reach beyond single precision's range and their decibels do not.
float level_db(float echo) { return echo > 0.0 ? 4.342944819 * log(echo) : kSilent; }

// Exponents and curve as GreyMap says.
float mapped(float g) {
  if (grey_map == 1) return pow(g, 0.75);
  if (grey_map == 2) return pow(g, 1.5);
  if (grey_map == 3) return g * g * (3.0 - 2.0 * g);
  return g;
}

vec4 grey_pixel(float level, float white_db) {
  float grey = level > kSilent ? 1.0 - clamp((white_db - level) / dynamic_range_db, 0.0, 1.0) : 0.0;
  return level == kOutsideFan ? vec4(0.0) : vec4(vec3(mapped(grey)), 1.0);
}

// Levels as whole numbers in the same order, which is what a maximum over invocations takes.
uint ordered(float level) {
  uint bits = floatBitsToUint(level);
  return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

float level_of(uint in_order) {
  return uintBitsToFloat((in_order & 0x80000000u) == 0u ? ~in_order : in_order & 0x7fffffffu);
}
