// Time gain compensation and gain, dB: linear between eight depths.
float time_gain_db(float sample_position) {
  float depth = clamp((sample_position + 0.5) / float(samples), 0.0, 1.0) * 7.0;
  int below = min(int(depth), 6);
  float low = tgc_db[below >> 2][below & 3];
  float high = tgc_db[(below + 1) >> 2][(below + 1) & 3];
  return gain_db + mix(low, high, depth - float(below));
}
