#pragma once

#include <string>

namespace insonate {

// Helpers for the drawings of a report.

/// Formats into a string as printf does: numbers in SVG need a fixed, short form.
[[gnu::format(printf, 1, 2)]] std::string print(const char* format, ...);

/// Returns a round number of about a fifth of the span: 1, 2 or 5 times a power of ten.
double round_step(double span);

}  // namespace insonate
