#pragma once

#include <string>
#include <vector>

namespace insonate {

// Values as a program writes them into a TOML file. Reading them back gives the same values.

/// Returns a text between quotation marks, on one line.
std::string toml_value(const std::string& text);
/// Returns a number with a decimal point or an exponent, so that TOML reads minus zero and whole numbers as floats.
std::string toml_value(double number);
/// Returns a list on one line.
std::string toml_value(const std::vector<std::string>& texts);
std::string toml_value(const std::vector<double>& numbers);

}  // namespace insonate
