#include "scenarios/report/svg.h"

#include <cmath>

#include "sim/core/text.h"

namespace insonate {

double round_step(double span) {
  const double power = std::pow(10.0, std::floor(std::log10(span / 5)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (span / (factor * power) <= 7) return factor * power;
  return 10 * power;
}

}  // namespace insonate
