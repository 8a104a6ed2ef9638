#pragma once

#include <string>

namespace insonate {

// Helpers for the drawings of a report.

/// Returns a round number of about a fifth of the span: 1, 2 or 5 times a power of ten.
double round_step(double span);

}  // namespace insonate
