#pragma once

#include <map>
#include <optional>
#include <string>

namespace insonate {

struct ArithmeticResult {
  std::optional<double> value;              ///< finite; empty when it could not be worked out
  std::optional<std::string> unknown_name;  ///< the first name that `values` lacks
  std::string problem;                      ///< why there is no value: "')' is missing at character 7"
};

/// Works out + - * / ( ), min(a, b) and max(a, b) over numbers and named values.
ArithmeticResult evaluate_arithmetic(const std::string& expression, const std::map<std::string, double>& values);

/// A whole text as one finite number, whatever the locale.
std::optional<double> parse_number(const std::string& text);

}  // namespace insonate
