// The weights of the lines of the active aperture, (4) of Kutter, Shams, Navab 2009. The file that includes this one
// declares `at_depth`. FOCUSED_BEAM selects a Gaussian, whose radius and exponent depend on depth, or the window, whose
// half width BEAM_HALF is compiled in, so that a narrow aperture needs no loop.
layout(std140, binding = 1) uniform Window { vec4 window[32]; };  // weights from the middle line outwards

#if FOCUSED_BEAM == 1
int radius;      // of the aperture at this sample, lines
float exponent;  // of the aperture's Gaussian
#else
const int radius = BEAM_HALF;
#endif

void place_aperture(vec4 depth) {
#if FOCUSED_BEAM == 1
  radius = int(depth.y);
  exponent = depth.z;
#endif
}

// Returns the weight of a line `away` lines from the aperture's middle.
float weight_at(int away) {
#if FOCUSED_BEAM == 1
  return abs(away) <= radius ? exp(exponent * float(away * away)) : 0.0;
#else
  int place = abs(away);
  return place <= radius ? window[place >> 2][place & 3] : 0.0;
#endif
}
