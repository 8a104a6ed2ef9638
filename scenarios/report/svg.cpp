#include "scenarios/report/svg.h"

#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace insonate {

std::string print(const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  char text[512];
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

double round_step(double span) {
  const double power = std::pow(10.0, std::floor(std::log10(span / 5)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (span / (factor * power) <= 7) return factor * power;
  return 10 * power;
}

}  // namespace insonate
