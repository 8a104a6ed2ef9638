#include "tools/bench/tables/svg.h"

#include "sim/core/text.h"

namespace insonate::bench {

const char kPlotStyle[] =
    "text{font:12px sans-serif;fill:#1d2733}.quiet{fill:#5f6c7b}.name{font-weight:600}"
    ".grid{stroke:#e3e8ee}.front{fill:none;stroke:#2567a8;stroke-width:1.5}";

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return safe;
}

}  // namespace insonate::bench
