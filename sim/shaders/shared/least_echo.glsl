// Echoes weaker than kMinEcho count as 0. They would become denormal numbers of single precision, which a
// processor computes many times more slowly. Their logarithms, which time gain would show, differ by device.
#include "shared/model_constants.h"

const float kMinIntensity = 1e-15;  // its square is kMinEcho
