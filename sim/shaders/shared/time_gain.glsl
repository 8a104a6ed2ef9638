// Returns gain and time gain, dB, at a share of the imaging depth. Time gain is linear between eight depths. It is
// summed over what each of the seven intervals adds, because a lookup of the two neighbours would cost one load per
// pixel.
float gain_at_db(float depth_share) {
#if TIME_GAIN == 1
  float depth = 7.0 * depth_share;
  vec4 first = clamp(depth - vec4(0.0, 1.0, 2.0, 3.0), 0.0, 1.0);
  vec3 second = clamp(depth - vec3(4.0, 5.0, 6.0), 0.0, 1.0);
  return gain_db + tgc_db[0].x + dot(first, vec4(tgc_db[0].yzw, tgc_db[1].x) - tgc_db[0]) +
         dot(second, tgc_db[1].yzw - tgc_db[1].xyz);
#else
  return gain_db;
#endif
}
