#pragma once

#include <map>
#include <optional>
#include <string>

namespace insonate {

/// The result of evaluate_arithmetic(): a value, or why there is none.
struct ArithmeticResult {
  std::optional<double> value;              ///< finite; empty if the expression has no value
  std::optional<std::string> unknown_name;  ///< the first name that is missing from `values`
  std::string problem;                      ///< why there is no value: "')' is missing at character 7"
};

/// Evaluates + - * / ( ), min(a, b) and max(a, b) over numbers and named values. Throws nothing of its own.
ArithmeticResult evaluate_arithmetic(const std::string& expression, const std::map<std::string, double>& values);

/// Returns a whole text as one finite number, in any locale; nothing if it is not one.
std::optional<double> parse_number(const std::string& text);

}  // namespace insonate
