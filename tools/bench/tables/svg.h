#pragma once

#include <string>

namespace insonate::bench {

/// Returns a text with the characters that XML reserves escaped.
std::string escaped(const std::string& text);

/// The look of the texts, grid lines and curves that plots share, as CSS.
extern const char kPlotStyle[];

}  // namespace insonate::bench
