#pragma once

#include <string>

namespace insonate {

// What the drawings of a report share.

/// printf into a string: numbers in SVG want a fixed, short form.
[[gnu::format(printf, 1, 2)]] std::string print(const char* format, ...);

/// A round number of about a fifth of the span: 1, 2 or 5 times a power of ten.
double round_step(double span);

}  // namespace insonate
