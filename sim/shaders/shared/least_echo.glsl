// Echoes weaker than kLeastEcho count as 0. They would become denormal numbers of single precision, which a
// processor computes many times more slowly. Their logarithms, which time gain would show, differ by device.
#include "shared/model_constants.h"

const float kLeastIntensity = 1e-15;  // its square is kLeastEcho
