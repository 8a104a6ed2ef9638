// A Gaussian window over pixels. Its radius is known when a shader is compiled, so that a narrow one needs no loop.
float gaussian(int away, int radius, float exponent) {
  return abs(away) <= radius ? exp(exponent * float(away * away)) : 0.0;
}
