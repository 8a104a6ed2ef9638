// Returns the weight of a Gaussian window `away` pixels from its middle. The radius is a compile-time constant, so that
// a narrow window needs no loop.
float gaussian(int away, int radius, float exponent) {
  return abs(away) <= radius ? exp(exponent * float(away * away)) : 0.0;
}
